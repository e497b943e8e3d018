#pragma once

#include <Eigen/Core>

namespace samewhere::twin {

// Weights of the four control points of a uniform cubic B-spline around the place `u` in [0, 1]
// between the second and the third; row k for the k-th derivative by u.
inline Eigen::Matrix<double, 3, 4> spline_weights(double u) {
  const double v = 1.0 - u;
  Eigen::Matrix<double, 3, 4> weights;
  weights << v * v * v / 6.0, (3.0 * u * u * u - 6.0 * u * u + 4.0) / 6.0,
      (3.0 * v * v * v - 6.0 * v * v + 4.0) / 6.0, u * u * u / 6.0,              //
      -0.5 * v * v, 1.5 * u * u - 2.0 * u, -1.5 * v * v + 2.0 * v, 0.5 * u * u,  //
      v, 3.0 * u - 2.0, 3.0 * v - 2.0, u;
  return weights;
}

}  // namespace samewhere::twin
