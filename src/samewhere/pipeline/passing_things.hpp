#pragma once

#include <deque>
#include <vector>

#include <samewhere/core/frame.hpp>
#include <samewhere/core/frame_pose.hpp>
#include <samewhere/features/features.hpp>
#include <samewhere/scene/map_version.hpp>
#include <samewhere/track/free_space.hpp>

namespace samewhere::pipeline {

// Where depth pictures of the last second saw nothing, something has come since: it moves, and is
// not to be taken for part of the building.
class PassingThings {
 public:
  explicit PassingThings(const track::FreeSpaceConfig& config = {}) : config_(config) {}

  // A frame with a pose; without depth nothing is remembered.
  void see(const core::Frame& frame, const core::FramePose& pose);

  // The poses seen so far are no longer poses of the map.
  void forget() { seen_.clear(); }

  // Features of the view that show what moves, by pictures of the second before it. The pose is its
  // own.
  std::vector<int> shown_in(const features::View& view, const core::FramePose& pose,
                            const scene::MapVersion& map) const;

 private:
  struct Seen {
    core::FramePose pose;
    core::Rigid3 body_from_camera;
    track::NearestSurface surface;
  };
  track::FreeSpaceConfig config_;
  std::deque<Seen> seen_;  // oldest first
};

}  // namespace samewhere::pipeline
