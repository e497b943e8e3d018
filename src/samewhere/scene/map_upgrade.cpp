#include <string>
#include <system_error>
#include <utility>

#include <samewhere/core/draft.hpp>
#include <samewhere/core/errors.hpp>
#include <samewhere/scene/map_file.hpp>
#include <samewhere/scene/map_upgrade.hpp>
#include <samewhere/scene/row_file.hpp>
#include <samewhere/scene/writer_lock.hpp>

namespace samewhere::scene {
namespace {

// The new file until it is complete; it is removed then, and one that a crash has left before.
class UpgradedCopy {
 public:
  explicit UpgradedCopy(const std::filesystem::path& of)
      : of_(of), path_(of.string() + std::string(core::kPartial) + "upgrade") {
    remove();
  }
  UpgradedCopy(const UpgradedCopy&) = delete;
  UpgradedCopy& operator=(const UpgradedCopy&) = delete;
  ~UpgradedCopy() { remove(); }

  const std::filesystem::path& path() const { return path_; }

  void replace_original() const {
    std::error_code error;
    std::filesystem::rename(path_, of_, error);
    if (error) throw core::InputError(of_.string() + ": cannot be replaced: " + error.message());
    core::sync_folder_of(of_);
  }

 private:
  void remove() const {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }

  std::filesystem::path of_;
  std::filesystem::path path_;
};

void write_current(MapFile& old, const std::filesystem::path& path) {
  StoredMap stored = old.load();
  for (std::size_t i = 0; i < stored.map.keyframes.size(); ++i) {
    const core::FrameId frame = stored.map.keyframes[i].view.frame;
    if (auto jpeg = old.thumbnail(frame))
      stored.extras.thumbnails.push_back({frame, std::move(*jpeg)});
  }
  MapFile::create(path, old.header()).commit(stored.map, stored.extras);
}

}  // namespace

bool upgrade_map_file(const std::filesystem::path& path) {
  if (MapFile::open(path).is_current()) return false;
  const WriterLock lock(path, WriterLock::File::kIsThere);  // outlives the connections
  RowFile::recover(path);  // a log beside it would be taken for that of the new file
  const UpgradedCopy copy(path);
  {
    MapFile old = MapFile::open(path);
    if (old.is_current()) return false;  // meanwhile
    write_current(old, copy.path());
  }
  copy.replace_original();
  return true;
}

}  // namespace samewhere::scene
