#pragma once

#include <optional>
#include <vector>

#include <samewhere/core/truth.hpp>
#include <samewhere/geometry/uncertain_pose.hpp>

namespace samewhere::evaluate {

// A measured motion of camera 0 with its covariance.
struct MeasuredMotion {
  double from_s = 0.0;
  double to_s = 0.0;
  geometry::UncertainPose from_from_to;
};

// Consistency of measured motions: NEES, e' covariance^-1 e of the errors e, whose mean is 6 for a
// consistent covariance (Bar-Shalom, Li and Kirubarajan, "Estimation with applications to tracking
// and navigation", 2001, section 5.4). Below 6 the covariance is too large; above, too small.
struct Consistency {
  int num_motions = 0;
  double mean = 0.0;      // NEES
  double median = 0.0;    // 5.35 if consistent
  double band_low = 0.0;  // 95 % interval of the mean if consistent
  double band_high = 0.0;
  double outliers = 0.0;  // share beyond the 99 % point, 16.81
};

// Over the motions with ground truth at both ends (truth_at); nothing with fewer than two. The band
// assumes independent normal errors: chi-square with 6 degrees of freedom for each motion, the mean
// of many nearly normal.
std::optional<Consistency> consistency(const std::vector<MeasuredMotion>& motions,
                                       const core::Trajectory& truth);

}  // namespace samewhere::evaluate
