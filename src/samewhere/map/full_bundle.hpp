#pragma once

#include <samewhere/map/local_bundle.hpp>

namespace samewhere::map {

// All of a map that takes part in a full bundle: every live keyframe is free but the oldest, or the
// two oldest where no depth says how large the world is. Landmarks that many keyframes see from
// near by go first; one more is taken as long as two of the keyframes that see it have fewer
// observations than `full_bundle_observations`. A keyframe left with too few to be held sits out.
// Nothing is free if the map is too small, or larger than `full_bundle_max_observations`.
BundleWindow window_of_all(const scene::MapVersion& map, const Config& config);

// How many observations of its landmarks the keyframes of the window have.
int num_observations(const scene::MapVersion& map, const BundleWindow& window);

// The edit that moves all keyframes of the window to where all their observations fit best. Unlike
// what a local bundle finds, where a keyframe is relative to its odometry parent rests on loops by
// then, and is in the edit as settled. Without depth, lengths around each keyframe are stretched as
// its landmarks say.
scene::Edit full_bundle(const scene::MapVersion& map, const BundleWindow& window,
                        const BundleSettings& settings);

// What a full bundle of `then` found, for the map that grew out of it while it was solved:
// keyframes move by as much as there, those that did not take part with their odometry ancestors;
// what was culled, merged or bettered since is left alone. Of one map: `now` is `then` and edits
// without loops.
scene::Edit carried_over(const scene::MapVersion& then, const scene::MapVersion& now,
                         const scene::Edit& found);

}  // namespace samewhere::map
