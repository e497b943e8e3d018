#pragma once

#include <vector>

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

// Covariance [m; rad] that they add to the pose of the end of a chain of odometry edges in its
// beginning. `path`: from the end back to the beginning, each keyframe the odometry parent or the
// child of the next. The heading is about the axis of the largest rotation variance of an edge, if
// there is one. To first order, and for the position to second order in the heading.
core::Matrix6d systematic_covariance(const scene::MapVersion& map,
                                     const std::vector<core::KeyframeId>& path,
                                     const SystematicDrift& drift);

}  // namespace samewhere::verify
