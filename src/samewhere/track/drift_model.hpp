#pragma once

#include <samewhere/core/rigid3.hpp>
#include <samewhere/features/features.hpp>
#include <samewhere/track/config.hpp>

namespace samewhere::track {

// Information of reference_from_body as odometry measured it, [m; rad]. Two errors are added: how
// well the frame was located in the local map, `covariance` of camera_from_reference by
// optimize::retract(), times DriftConfig::factor, since the map was located no better and passes
// its errors on; and what no residual shows, as a calibration that is a little wrong: rates per
// metre and radian.
core::Matrix6d odometry_information(const core::Rigid3& camera_from_reference,
                                    const core::Rigid3& body_from_camera,
                                    const core::Matrix6d& covariance, bool is_weak,
                                    const DriftConfig& config);

// As it is for this view: `factor` is factor_without_depth if no feature of it has depth.
DriftConfig drift_of(const features::View& view, const DriftConfig& config);

// The same information, of the pose relative to another reference, which is known relative to the
// first.
core::Matrix6d seen_from(const core::Rigid3& new_from_old_reference,
                         const core::Matrix6d& information);

}  // namespace samewhere::track
