#pragma once

#include <optional>
#include <vector>

#include <samewhere/core/truth.hpp>
#include <samewhere/geometry/uncertain_pose.hpp>

namespace samewhere::evaluate {

// A motion of camera 0 that somebody measured, with how sure they are of it.
struct MeasuredMotion {
  double from_s = 0.0;
  double to_s = 0.0;
  geometry::UncertainPose from_from_to;
};

// Whether somebody who measures motions is as good as they say: e' covariance^-1 e of their errors
// e, which for an honest one has the mean 6 (Bar-Shalom, Li and Kirubarajan, "Estimation with
// applications to tracking and navigation", 2001, section 5.4). Below, they are better than they
// say; above, worse.
struct Consistency {
  int num_motions = 0;
  double mean = 0.0;      // of the normalised error squared
  double median = 0.0;    // an honest one has 5.35
  double band_low = 0.0;  // 95 % of honest ones have a mean within
  double band_high = 0.0;
  double outliers = 0.0;  // share beyond the 99 % point, 16.81
};

// Over the motions whose both ends have a truth (truth_at); nothing with fewer than two. The band
// takes errors as independent and normal: chi-square with 6 degrees of freedom a motion, whose mean
// over many is nearly normal.
std::optional<Consistency> consistency(const std::vector<MeasuredMotion>& motions,
                                       const core::Trajectory& truth);

}  // namespace samewhere::evaluate
