#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include <samewhere/core/rig.hpp>
#include <samewhere/pipeline/config.hpp>
#include <samewhere/pipeline/messages.hpp>
#include <samewhere/scene/map_file.hpp>

namespace samewhere::run {

// The settings that the map of a run hangs on: camera and body, section `features`, describer.
scene::MapHeader map_header(const pipeline::Config& config, const core::Rig& rig,
                            std::uint64_t describer_checksum);

// Keeps a growing map in a file. What cannot be written ends the saving, not the run.
class MapSaver {
 public:
  // The file is made when there is something to save; there is none yet.
  MapSaver(std::filesystem::path path, const pipeline::Config& config,
           std::uint64_t describer_checksum);

  // Goes on with a file that was opened to be extended, and loaded.
  explicit MapSaver(scene::MapFile file);

  // One transaction. The map holds a keyframe.
  void save(const scene::MapVersion& map, const pipeline::MapNews& news);

  // Why the file lacks what came last.
  const std::optional<std::string>& error() const { return error_; }

 private:
  std::filesystem::path path_;
  pipeline::Config config_;
  std::uint64_t describer_checksum_ = 0;
  std::optional<scene::MapFile> file_;
  std::optional<std::string> error_;
};

}  // namespace samewhere::run
