#pragma once

#include <optional>

#include <samewhere/optimize/bundle.hpp>

namespace samewhere::optimize {

// Correction of the focal length that all cameras of a problem share.
struct FocalLengthFit {
  double ratio = 1.0;  // found / assumed
  // Standard deviation of the ratio if errors of pixels were independent: a lower limit.
  double ratio_sigma = 0.0;
};

// The focal length that fits all observations best together with all poses and points: a bundle
// adjustment with a Huber loss and one more unknown. A prior of standard deviation `prior_sigma`,
// as a share, keeps it near the assumed one where the motion does not determine it. Depth is not
// used. Nothing if the observations do not determine it: fewer than 200, or an optimum without
// curvature. Throws ContractError without any fixed camera.
std::optional<FocalLengthFit> fit_focal_length(const BundleProblem& problem, double prior_sigma);

}  // namespace samewhere::optimize
