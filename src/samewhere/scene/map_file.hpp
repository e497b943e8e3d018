#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <samewhere/core/descriptor.hpp>
#include <samewhere/core/frame_pose.hpp>
#include <samewhere/scene/map_version.hpp>

namespace samewhere::scene {

// The settings a map hangs on (camera, features, describer), by name, as text. A map goes on only
// under the same.
using MapHeader = std::map<std::string, std::string>;

// A small picture of a frame, to be looked at.
struct Thumbnail {
  core::FrameId frame;
  std::string jpeg;
};

// What belongs to a map beside the map itself.
struct MapExtras {
  std::vector<core::FramePose> frames;  // to derive a trajectory from
  std::vector<core::Descriptor>
      descriptors;                    // of keyframes' views: the place index is made of them
  std::vector<std::string> ledger;    // verified candidates, each as one line of JSON
  std::vector<Thumbnail> thumbnails;  // of keyframes; to be written alone: see thumbnail()
};

struct StoredMap {
  MapVersion map;
  MapExtras extras;  // frames and descriptors ascend by frame id
};

enum class MapAccess { kRead, kExtend };

// A map in one SQLite file that holds, at any moment, the map of the last commit: after kill -9 all
// that was committed is there, after a power cut maybe not the last commits (WAL with
// synchronous=NORMAL). Each row carries a checksum. One program writes (a second is
// refused, writer_lock.hpp), others may read meanwhile.
// Every trouble with the file is an InputError of one line that begins with its path.
class MapFile {
 public:
  // A new file. Throws InputError if there is one already or it cannot be written; then nothing is
  // left behind.
  static MapFile create(const std::filesystem::path& path, const MapHeader& header);
  // Throws InputError if there is no such file, it is no map, it is of another version, or damaged.
  static MapFile open(const std::filesystem::path& path, MapAccess access = MapAccess::kRead);

  MapFile(MapFile&&) noexcept;
  MapFile& operator=(MapFile&&) noexcept;
  // Leaves one plain file, which opens in a folder that cannot be written, too.
  ~MapFile();

  const MapHeader& header() const;
  // Whether it is of the version that is written; maps of the version before are read only.
  bool is_current() const;
  // Throws InputError naming the first setting, by name, that differs, and both values.
  void require_same_settings(const MapHeader& expected) const;

  // Says at once, rather than at the first commit, if a file that was opened to be extended cannot
  // be written. Before this the file keeps its bytes.
  void begin_writing();

  // Everything but the thumbnails, exactly as it was committed. The file may come from anywhere:
  // every number is checked before it is used (map_values.hpp), and so are all links between rows
  // (map_check.hpp). Throws InputError naming what is damaged or missing.
  StoredMap load();

  // The verified candidates alone, as StoredMap has them.
  std::vector<std::string> ledger();

  // The picture of the frame, if there is one. Throws InputError if it is damaged.
  std::optional<std::string> thumbnail(core::FrameId frame);

  // Writes in one transaction what the map has that the last commit had not: rows are compared only
  // where the two versions do not share memory. Extras: frames are new or written anew;
  // descriptors, ledger and thumbnails are added. A file that was opened is loaded before. Throws
  // InputError if it cannot be written; the file then holds the last commit.
  void commit(const MapVersion& after, const MapExtras& extras);

 private:
  class Content;
  explicit MapFile(std::unique_ptr<Content> content);
  std::unique_ptr<Content> content_;
};

}  // namespace samewhere::scene
