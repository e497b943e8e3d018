#pragma once

#include <set>
#include <vector>

#include <samewhere/features/config.hpp>
#include <samewhere/map/config.hpp>
#include <samewhere/optimize/bundle.hpp>
#include <samewhere/scene/map_version.hpp>

namespace samewhere::map {

// Keyframes and landmarks of a bundle adjustment, by id.
struct BundleWindow {
  std::vector<core::KeyframeId> free;   // ascending: poses are estimated
  std::vector<core::KeyframeId> fixed;  // ascending: observe the landmarks, too
  std::vector<core::LandmarkId>
      landmarks;  // ascending: seen by two keyframes of the window or more
};

// The window of local bundle adjustment: the keyframe and its most covisible keyframes are free,
// others that observe their landmarks are fixed, within the limits of the config; keyframes with
// most common landmarks, and landmarks with most observations, come first. The gauge: if no
// keyframe is left to be fixed, the oldest is, and the two oldest where no depth fixes the scale.
BundleWindow window_around(const scene::MapVersion& map, core::KeyframeId keyframe,
                           const Config& config);

// The same around given keyframes, at least one, all of which are free.
BundleWindow window_of(const scene::MapVersion& map, std::set<core::KeyframeId> free,
                       const Config& config);

struct BundleSettings {
  Config map;
  features::Config features;
  optimize::Config optimize;
};

// The least squares problem of a window: its free keyframes, then its fixed ones, and its
// landmarks.
optimize::BundleProblem bundle_problem(const scene::MapVersion& map, const BundleWindow& window,
                                       const features::Config& config);

// The edit that moves the free keyframes and their landmarks to the optimum and removes outlier
// observations. Odometry edges stay as they were measured; the refined pose of a keyframe relative
// to its odometry parent is in the refinements of the edit.
scene::Edit bundle_around(const scene::MapVersion& map, core::KeyframeId keyframe,
                          const BundleSettings& settings);

// The same for a given window.
scene::Edit bundle(const scene::MapVersion& map, const BundleWindow& window,
                   const BundleSettings& settings);

}  // namespace samewhere::map
