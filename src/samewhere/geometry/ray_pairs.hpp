#pragma once

#include <algorithm>
#include <vector>

#include <Eigen/Core>

namespace samewhere::geometry {

// The directions in which two calibrated cameras saw the same points.
struct RayPairs {
  std::vector<Eigen::Vector3d> first;   // unit vectors in the first camera, z > 0
  std::vector<Eigen::Vector3d> second;  // as many in the second
  double focal_px = 1.0;                // converts errors on the plane z = 1 to pixels

  int size() const { return static_cast<int>(first.size()); }
};

// The pairs at these indices.
RayPairs subset(const RayPairs& pairs, const std::vector<int>& indices);

// How far a model's prediction is off in either picture, square pixels.
struct TransferError {
  double in_first = 0.0;
  double in_second = 0.0;

  double larger() const { return std::max(in_first, in_second); }
};

}  // namespace samewhere::geometry
