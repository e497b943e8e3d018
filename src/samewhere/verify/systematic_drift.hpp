#pragma once

#include <samewhere/core/rigid3.hpp>
#include <samewhere/scene/map_version.hpp>

namespace samewhere::verify {

// Errors of odometry that are the same all along a run, as a wrong wheel radius: they grow with the
// distance, not with its root. Standard deviations; all zero: none.
struct SystematicDrift {
  double per_metre = 0.0;       // metres per metre: all distances are too long or too short
  double rad_per_metre = 0.0;   // the heading turns with the distance
  double rad_per_radian = 0.0;  // all turns are too large or too small
  double rad_per_s = 0.0;       // the heading turns with time
  double tilt_ratio = 1.0;      // of roll and pitch over the heading

  bool is_none() const {
    return per_metre == 0.0 && rad_per_metre == 0.0 && rad_per_radian == 0.0 && rad_per_s == 0.0;
  }
};

// Of distances, of turns, of the heading by distance and by time, and of rotation about each axis
// of the body by distance and by time: twists [m; rad], one column for an error of one standard
// deviation.
using ConstantErrors = Eigen::Matrix<double, 6, 10>;

// How an odometry edge moves all that comes after it, about the origin of the frame in which both
// poses are. The heading is about the axis of the largest rotation variance of the edge, if there
// is one. `covariance`: of the edge.
ConstantErrors constant_errors(const core::Rigid3& parent, const core::Rigid3& child,
                               const core::Matrix6d& covariance, double duration_s,
                               const SystematicDrift& drift);

}  // namespace samewhere::verify
