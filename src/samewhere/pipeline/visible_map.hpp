#pragma once

#include <optional>
#include <utility>

#include <samewhere/map/config.hpp>
#include <samewhere/scene/local_map.hpp>
#include <samewhere/scene/map_version.hpp>
#include <samewhere/scene/tracked_view.hpp>
#include <samewhere/track/tracker.hpp>

namespace samewhere::pipeline {

// The map as tracking sees it: the version that mapping sent last, and the local map of the
// reference keyframe.
class VisibleMap {
 public:
  explicit VisibleMap(const map::Config& config, scene::MapVersion version = {})
      : config_(config), version_(std::move(version)) {}

  const scene::MapVersion& version() const { return version_; }
  const scene::LocalMap& local_map() const { return local_map_; }
  bool has_local_map() const { return local_map_.size() > 0; }
  core::KeyframeId reference() const { return local_map_.reference; }

  // The local map stays that of the earlier version until a reference is set.
  void set_version(scene::MapVersion version) { version_ = std::move(version); }
  void set_reference(core::KeyframeId reference);
  void set_local_map(scene::LocalMap local_map) { local_map_ = std::move(local_map); }

  core::Rigid3 world_from(const core::FramePose& pose) const;
  core::Rigid3 reference_from(const core::FramePose& pose) const;
  // The same pose with another reference keyframe.
  core::FramePose relative_to(core::KeyframeId reference, core::FramePose pose) const;
  // Relative to the newest keyframe if the chain from there to the pose's reference takes a loop
  // edge: a recorded pose has to stay valid if the loop is withdrawn. Without effect if the newest
  // keyframe's index is below `tracked_since_keyframe`: no odometry leads to the pose.
  core::FramePose by_odometry(const core::FramePose& pose, std::uint64_t tracked_since_keyframe);
  // With landmarks of the local map.
  scene::TrackedView tracked_view(const features::View& view, const track::Track& track) const;

 private:
  struct Chain {
    std::uint64_t map_number = 0;
    core::KeyframeId from;
    core::KeyframeId to;
    bool operator==(const Chain&) const = default;
  };

  map::Config config_;
  scene::MapVersion version_;
  scene::LocalMap local_map_;
  std::optional<std::pair<Chain, bool>> last_chain_;  // whether it takes a loop edge
};

}  // namespace samewhere::pipeline
