#pragma once

#include <optional>
#include <vector>

#include <samewhere/scene/map_version.hpp>

namespace samewhere::scene {

// The landmarks that a camera near the reference keyframe may see, as arrays of equal length: first
// the near ones, among which a camera looks that does not know where it is.
struct LocalMap {
  core::KeyframeId reference;
  int num_near = 0;
  std::vector<core::LandmarkId> landmarks;
  std::vector<Eigen::Vector3d> points_in_reference;  // body frame of the reference, metres
  std::vector<double> range_m;                       // from which each was described
  std::vector<int> octave;                           // at that range
  cv::Mat descriptors;                               // one row each

  int size() const { return static_cast<int>(landmarks.size()); }
};

// Number of covisible keyframes of a local map, and of the nearest ones among them.
struct Neighbours {
  int all = 0;
  int near = 0;
};

// Landmarks of the reference and of its near neighbours, ascending by id, then those of the others.
LocalMap build_local_map(const MapVersion& map, core::KeyframeId reference, Neighbours neighbours);

// The keyframe that observes most of these landmarks, of any age: the reference of the local map of
// a frame that observes them. Nothing if none observes any.
std::optional<core::KeyframeId> keyframe_showing_most(
    const MapVersion& map, const std::vector<core::LandmarkId>& landmarks);

}  // namespace samewhere::scene
