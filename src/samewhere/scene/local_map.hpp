#pragma once

#include <optional>
#include <vector>

#include <samewhere/scene/map_version.hpp>

namespace samewhere::scene {

// The landmarks that a camera near the reference keyframe may see, as arrays of equal length.
struct LocalMap {
  core::KeyframeId reference;
  std::vector<core::LandmarkId> landmarks;
  std::vector<Eigen::Vector3d> points_in_reference;  // body frame of the reference, metres
  std::vector<double> range_m;                       // from which each was described
  std::vector<int> octave;                           // at that range
  cv::Mat descriptors;                               // one row each

  int size() const { return static_cast<int>(landmarks.size()); }
};

// Landmarks of the reference and of up to `max_neighbours` keyframes that share most landmarks with
// it, ascending by id.
LocalMap build_local_map(const MapVersion& map, core::KeyframeId reference, int max_neighbours);

// The keyframe that shows most of these landmarks, however old: what lies around it is the local
// map of who sees them. Nothing if none shows any.
std::optional<core::KeyframeId> keyframe_showing_most(
    const MapVersion& map, const std::vector<core::LandmarkId>& landmarks);

}  // namespace samewhere::scene
