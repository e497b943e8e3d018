#pragma once

#include <samewhere/core/rigid3.hpp>

namespace samewhere::geometry {

// A relative pose with the covariance of its error [translation in a (m); rotation on the right
// (rad)].
struct UncertainPose {
  core::Rigid3 a_from_b;
  core::Matrix6d covariance = core::Matrix6d::Zero();
};

// First-order propagation (Smith, Self and Cheeseman 1990); the two errors are independent.
UncertainPose compose(const UncertainPose& a_from_b, const UncertainPose& b_from_c);
UncertainPose inverse(const UncertainPose& a_from_b);

}  // namespace samewhere::geometry
