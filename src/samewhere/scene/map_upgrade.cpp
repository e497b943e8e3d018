#include <optional>
#include <system_error>
#include <utility>

#include <samewhere/core/errors.hpp>
#include <samewhere/scene/map_file.hpp>
#include <samewhere/scene/map_upgrade.hpp>
#include <samewhere/scene/writer_lock.hpp>

namespace samewhere::scene {
namespace {

void write_current(MapFile& old, const std::filesystem::path& draft) {
  StoredMap stored = old.load();
  for (std::size_t i = 0; i < stored.map.keyframes.size(); ++i) {
    const core::FrameId frame = stored.map.keyframes[i].view.frame;
    if (auto jpeg = old.thumbnail(frame))
      stored.extras.thumbnails.push_back({frame, std::move(*jpeg)});
  }
  MapFile::create(draft, old.header()).commit(stored.map, stored.extras);
}

}  // namespace

bool upgrade_map_file(const std::filesystem::path& path) {
  const std::filesystem::path draft = path.string() + ".upgrade";
  {
    MapFile old = MapFile::open(path);
    if (old.is_current()) return false;
    const WriterLock lock(path, WriterLock::File::kIsThere);
    try {
      write_current(old, draft);
    } catch (const core::InputError&) {
      std::error_code ignored;
      std::filesystem::remove(draft, ignored);
      throw;
    }
  }
  std::error_code error;
  std::filesystem::rename(draft, path, error);
  if (error) throw core::InputError(path.string() + ": cannot be replaced: " + error.message());
  return true;
}

}  // namespace samewhere::scene
