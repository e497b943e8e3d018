#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include <samewhere/geometry/ransac.hpp>

namespace samewhere::geometry {

// Pixels of the same points in two pictures.
struct PixelPairs {
  std::vector<Eigen::Vector2d> first_px;
  std::vector<Eigen::Vector2d> second_px;  // as many
};

// Fundamental matrices F with second' F first = 0 (at most three) through seven pairs; Hartley and
// Zisserman 2004, section 11.1.2.
std::vector<Eigen::Matrix3d> solve_fundamental_7(const PixelPairs& seven);

// The same by least squares from eight or more pairs with rank 2 enforced (Hartley 1997). Nothing
// if degenerate.
std::optional<Eigen::Matrix3d> solve_fundamental_8(const PixelPairs& pairs);

// Squared Sampson distance, square pixels: first-order distance of the pair to the nearest pair
// that fits F.
double sampson_squared(const Eigen::Matrix3d& fundamental, const Eigen::Vector2d& first,
                       const Eigen::Vector2d& second);

// The fundamental matrix that most pairs agree on: RANSAC over seven pairs, refined on its inliers.
std::optional<RansacResult<Eigen::Matrix3d>> estimate_fundamental(const PixelPairs& pairs,
                                                                  const RansacOptions& options,
                                                                  core::Random& random);

}  // namespace samewhere::geometry
