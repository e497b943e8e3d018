#pragma once

#include <compare>
#include <cstdint>

#include <Eigen/Core>

namespace samewhere::dense {

// A cube of space: the integer parts of its points' coordinates, in units of its edge. Ordered.
struct VoxelKey {
  std::int32_t x = 0;
  std::int32_t y = 0;
  std::int32_t z = 0;

  friend auto operator<=>(const VoxelKey&, const VoxelKey&) = default;
};

inline VoxelKey voxel_of(const Eigen::Vector3f& point_m, double edge_m) {
  const Eigen::Vector3d scaled = (point_m.cast<double>() / edge_m).array().floor();
  return {static_cast<std::int32_t>(scaled.x()), static_cast<std::int32_t>(scaled.y()),
          static_cast<std::int32_t>(scaled.z())};
}

// The cube of twice the edge that this one is part of.
inline VoxelKey parent_of(const VoxelKey& key) { return {key.x >> 1, key.y >> 1, key.z >> 1}; }

// Primes of Teschner et al. 2003 (Optimized spatial hashing).
struct VoxelHash {
  std::size_t operator()(const VoxelKey& key) const {
    return static_cast<std::size_t>(key.x) * 73856093U ^
           static_cast<std::size_t>(key.y) * 19349663U ^
           static_cast<std::size_t>(key.z) * 83492791U;
  }
};

}  // namespace samewhere::dense
