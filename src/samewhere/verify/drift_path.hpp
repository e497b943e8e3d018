#pragma once

#include <optional>

#include <samewhere/core/ids.hpp>
#include <samewhere/core/rigid3.hpp>
#include <samewhere/scene/map_version.hpp>
#include <samewhere/verify/systematic_drift.hpp>

namespace samewhere::verify {

// Covariance of the pose of `end` in `begin`, [m; rad], along the path of odometry and loop edges
// with the least drift: what earlier loops have taken out of the drift. An upper bound of the
// marginal covariance of the pose graph, since other paths add information. Nothing if no path
// joins the two. `bias`: of odometry from a file. Not for maps with scale drift.
std::optional<core::Matrix6d> covariance_with_loops(const scene::MapVersion& map,
                                                    core::KeyframeId begin, core::KeyframeId end,
                                                    const SystematicDrift& bias);

}  // namespace samewhere::verify
