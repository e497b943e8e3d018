#pragma once

#include <filesystem>
#include <map>

#include <samewhere/core/channel.hpp>
#include <samewhere/pipeline/config.hpp>
#include <samewhere/pipeline/messages.hpp>
#include <samewhere/scene/map_file.hpp>

namespace samewhere::library {

// The map as mapping has completed it last, with what a map file holds beside it but thumbnails.
class KeptMap {
 public:
  // In mapping's thread.
  void note(const scene::MapVersion& map, const pipeline::MapNews& news);
  // In any thread. Throws core::InputError as MapFile does, and if there is no map yet.
  void save(const std::filesystem::path& file, const pipeline::Config& config,
            std::uint64_t describer_checksum);

 private:
  struct Content {
    scene::MapVersion map;
    std::map<core::FrameId, core::FramePose> frames;
    std::vector<core::Descriptor> descriptors;
    core::Ledger rows;
  };
  core::Guarded<Content> content_;
};

}  // namespace samewhere::library
