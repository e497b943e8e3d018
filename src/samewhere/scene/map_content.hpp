#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <samewhere/core/paged_memory.hpp>
#include <samewhere/scene/map_file.hpp>
#include <samewhere/scene/map_tables.hpp>
#include <samewhere/scene/row_file.hpp>

namespace samewhere::scene {

// The rows of a map file, with the map of the last commit, to which the next one is compared.
class MapFile::Content {
 public:
  // Of a new file.
  Content(const std::filesystem::path& path, const MapHeader& header);
  // Of one that is there.
  Content(const std::filesystem::path& path, core::OpenMode mode);

  const MapHeader& header() const { return header_; }
  const std::filesystem::path& path() const { return file_.path(); }

  void begin_writing() { file_.begin_writing(); }
  StoredMap load();
  std::vector<std::string> ledger();
  std::optional<std::string> thumbnail(core::FrameId frame);
  bool is_current() const { return file_.version() == kMapFileVersion; }
  // On a full disk a second time, with the room that the log took.
  void commit(const MapVersion& after, const MapExtras& extras);

 private:
  void write(const MapVersion& after, const MapExtras& extras);
  // Since this one has read or written it: for what was not locked out (a network drive).
  void require_unchanged();
  MapState read_state();
  void read_rigs();
  features::View read_view(const RowFile::Row& row);
  void read_keyframes(MapVersion& map);
  void read_extras(MapExtras& extras);

  void write_keyframes(const MapVersion& after, MapState& state);
  void write_landmarks(const MapVersion& after, MapState& state);
  void read_loops(const char* table, std::uint64_t count, std::vector<LoopEdge>& loops);
  void write_loops(const char* table, const std::vector<LoopEdge>& before,
                   const std::vector<LoopEdge>& after);
  void write_merges(const MapVersion& after, MapState& state);
  void write_extras(const MapExtras& extras, MapState& state);
  std::uint64_t rig_number(const core::Rig& rig, MapState& state);
  template <class T>
  void put_change(const char* table, std::int64_t number, const T* before, const T& now);

  RowFile file_;
  MapHeader header_;
  // As of the last commit.
  bool is_loaded_ = false;
  MapState state_;
  MapVersion map_;
  std::vector<std::shared_ptr<const core::Rig>> rigs_;
  core::PagedMemory feature_memory_;
};

}  // namespace samewhere::scene
