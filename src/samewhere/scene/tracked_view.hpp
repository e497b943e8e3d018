#pragma once

#include <utility>
#include <vector>

#include <samewhere/core/frame_pose.hpp>
#include <samewhere/core/ids.hpp>
#include <samewhere/features/features.hpp>

namespace samewhere::scene {

// A view with a pose, and which of its features show which landmarks of the map.
struct TrackedView {
  features::View view;
  core::FramePose pose;
  std::vector<std::pair<int, core::LandmarkId>> landmarks;  // feature, landmark
  // features of what moves, or may: their own depth makes them no landmarks
  std::vector<int> passing;
};

}  // namespace samewhere::scene
