#pragma once

#include <samewhere/map/local_bundle.hpp>

namespace samewhere::map {

// The window of full bundle adjustment: every live keyframe is free but the oldest, or the two
// oldest where no depth fixes the scale. Landmarks with most and nearest observations come first;
// one more is taken while two of its keyframes have fewer observations than
// `full_bundle_observations`. A keyframe with too few observations is left out. Nothing is free if
// the map is too small, or larger than `full_bundle_max_observations`.
BundleWindow window_of_all(const scene::MapVersion& map, const Config& config);

// How many observations of its landmarks the keyframes of the window have.
int num_observations(const scene::MapVersion& map, const BundleWindow& window);

// The edit that moves all keyframes of the window to the optimum of their observations. Unlike
// after local bundle adjustment, the relative pose of a keyframe and its odometry parent now
// depends on loops; the edit marks it as settled. Without depth, each keyframe is scaled as its
// landmarks.
scene::Edit full_bundle(const scene::MapVersion& map, const BundleWindow& window,
                        const BundleSettings& settings);

// The result of a full bundle adjustment of `then`, applied to the map that grew out of it
// meanwhile: keyframes move by the same amount, those outside the window with their odometry
// ancestors; what was culled, merged or refined since is unchanged. `now` is `then` and edits
// without loops.
scene::Edit carried_over(const scene::MapVersion& then, const scene::MapVersion& now,
                         const scene::Edit& found);

}  // namespace samewhere::map
