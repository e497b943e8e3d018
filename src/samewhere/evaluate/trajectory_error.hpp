#pragma once

#include <optional>

#include <samewhere/core/rigid3.hpp>
#include <samewhere/core/truth.hpp>

namespace samewhere::evaluate {

// Truth at a moment between its stamps: linear in position, spherical in rotation. Nothing where
// the truth has a gap of more than 0.1 s, unless one of its own stamps lies within 1 ms; nothing
// from a truth of fewer than two poses.
std::optional<core::Rigid3> truth_at(const core::Trajectory& truth, double stamp_s);

// kSe3: the estimate's metres count (RGB-D, stereo). kSim3: its scale is free (monocular).
enum class Alignment { kSe3, kSim3 };

// Absolute trajectory error, metres, after alignment of the positions.
struct AteResult {
  double max_m = 0.0;
  double min_m = 0.0;
  double median_m = 0.0;
  double rmse_m = 0.0;
  int num_poses = 0;   // of the estimate, that have a truth
  double scale = 1.0;  // of truth_from_estimate
  core::Sim3 truth_from_estimate;
};

// Absolute trajectory error: eq. (24)-(25) of the paper, with ground truth interpolated to the
// estimate's stamps (truth_at) and least squares alignment (geometry::align_points). Both
// trajectories are of camera 0. Nothing with fewer than 3 poses that have a truth.
std::optional<AteResult> ate(const core::Trajectory& truth, const core::Trajectory& estimate,
                             Alignment alignment);

// Length of the path between two stamps, metres, summed from pose to pose.
double path_length_m(const core::Trajectory& trajectory, double first_s, double last_s);

// Relative pose error: drift over a fixed time, free of any alignment.
struct RpeResult {
  double translation_median_m = 0.0;
  double translation_rmse_m = 0.0;
  double rotation_median_deg = 0.0;
  double rotation_rmse_deg = 0.0;
  int num_pairs = 0;
};

// Error of the estimated motion over delta_s > 0 seconds: for every pose with a truth, against the
// pose nearest to delta_s later, if that is within a tenth of delta_s and has a truth (Sturm et
// al., "A benchmark for the evaluation of RGB-D SLAM systems", IROS 2012). `scale` multiplies the
// estimate's translations (monocular: AteResult::scale). Nothing where there is no such pair.
std::optional<RpeResult> rpe(const core::Trajectory& truth, const core::Trajectory& estimate,
                             double delta_s = 1.0, double scale = 1.0);

}  // namespace samewhere::evaluate
