#include <fmt/format.h>

#include <samewhere/scene/map_content.hpp>
#include <samewhere/scene/map_file.hpp>

namespace samewhere::scene {

MapFile::MapFile(std::unique_ptr<Content> content) : content_(std::move(content)) {}
MapFile::MapFile(MapFile&&) noexcept = default;
MapFile& MapFile::operator=(MapFile&&) noexcept = default;
MapFile::~MapFile() = default;

MapFile MapFile::create(const std::filesystem::path& path, const MapHeader& header) {
  return MapFile(std::make_unique<Content>(path, header));
}

MapFile MapFile::open(const std::filesystem::path& path, MapAccess access) {
  const core::OpenMode mode =
      access == MapAccess::kRead ? core::OpenMode::kRead : core::OpenMode::kWrite;
  return MapFile(std::make_unique<Content>(path, mode));
}

const MapHeader& MapFile::header() const { return content_->header(); }

bool MapFile::is_current() const { return content_->is_current(); }

void MapFile::require_same_settings(const MapHeader& expected) const {
  for (const auto& [name, value] : expected) {
    const auto made_with = header().find(name);
    const std::string found = made_with == header().end() ? "unknown" : made_with->second;
    if (found == value) continue;
    throw core::InputError(fmt::format("{}: the map was made with {} = {}; this run has {}",
                                       content_->path().string(), name, found, value));
  }
}

void MapFile::begin_writing() { content_->begin_writing(); }

StoredMap MapFile::load() { return content_->load(); }

std::vector<std::string> MapFile::ledger() { return content_->ledger(); }

std::optional<std::string> MapFile::thumbnail(core::FrameId frame) {
  return content_->thumbnail(frame);
}

void MapFile::commit(const MapVersion& after, const MapExtras& extras) {
  content_->commit(after, extras);
}

}  // namespace samewhere::scene
