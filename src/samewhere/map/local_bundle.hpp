#pragma once

#include <set>
#include <vector>

#include <samewhere/features/config.hpp>
#include <samewhere/map/config.hpp>
#include <samewhere/optimize/bundle.hpp>
#include <samewhere/scene/map_version.hpp>

namespace samewhere::map {

// Who takes part in a bundle, by id.
struct BundleWindow {
  std::vector<core::KeyframeId> free;   // ascending: whose poses are sought
  std::vector<core::KeyframeId> fixed;  // ascending: who sees the landmarks, too
  std::vector<core::LandmarkId>
      landmarks;  // ascending: seen by two keyframes of the window or more
};

// The keyframe and those that share most landmarks with it are free, others that see their
// landmarks are fixed, within the limits of the config: keyframes that share most, and landmarks
// that most keyframes see, go first. The gauge: if nobody is left to be fixed, the oldest is, and
// the two oldest where no depth says how large the world is.
BundleWindow window_around(const scene::MapVersion& map, core::KeyframeId keyframe,
                           const Config& config);

// The same around keyframes of one's own choice, at least one, all of which are free.
BundleWindow window_of(const scene::MapVersion& map, std::set<core::KeyframeId> free,
                       const Config& config);

struct BundleSettings {
  Config map;
  features::Config features;
  optimize::Config optimize;
};

// The problem of a window: its free keyframes, then its fixed ones, and its landmarks.
optimize::BundleProblem bundle_problem(const scene::MapVersion& map, const BundleWindow& window,
                                       const features::Config& config);

// The edit that moves the keyframe, its neighbours and what they see to where all their
// observations fit best, and takes out the observations that do not. Odometry edges stay as they
// were measured; where the bundle found a keyframe relative to its odometry parent is in the
// edit's refinements.
scene::Edit bundle_around(const scene::MapVersion& map, core::KeyframeId keyframe,
                          const BundleSettings& settings);

// The same for a window of one's own.
scene::Edit bundle(const scene::MapVersion& map, const BundleWindow& window,
                   const BundleSettings& settings);

}  // namespace samewhere::map
