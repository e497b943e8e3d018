#pragma once

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include <Eigen/Core>

#include <samewhere/dense/config.hpp>
#include <samewhere/dense/view.hpp>
#include <samewhere/dense/voxel.hpp>

namespace samewhere::dense {

struct CloudPoint {
  Eigen::Vector3f in_world = Eigen::Vector3f::Zero();
  std::array<std::uint8_t, 3> rgb{};
};

// Fused surface: one coloured point per voxel, the mean of its observations, each weighted by
// 1 / depth^2, as the noise of a depth sensor grows. Holds at most config.max_voxels voxels: beyond
// that the voxel size doubles and eight become one.
class VoxelCloud {
 public:
  explicit VoxelCloud(const Config& config);

  void add(const std::vector<SeenPoint>& points_of_one_view);

  // The voxels that at least config.min_views views saw, ordered by place; the same views in the
  // same order give the same points.
  std::vector<CloudPoint> points() const;
  double voxel_m() const { return voxel_m_; }

 private:
  struct Voxel {
    VoxelKey key;
    float weight = 0.0F;
    Eigen::Vector3f position_m = Eigen::Vector3f::Zero();  // mean
    Eigen::Vector3f rgb = Eigen::Vector3f::Zero();         // mean
    int last_view = -1;
    int num_views = 0;  // at least so many: coarser voxels do not know which views they share
  };

  static void blend(Voxel& voxel, const Voxel& more);
  void put(const Voxel& voxel);
  void double_edge();

  Config config_;
  double voxel_m_;
  int num_views_ = 0;
  std::vector<Voxel> voxels_;  // in the order of their first observation
  std::unordered_map<VoxelKey, std::uint32_t, VoxelHash> index_of_;  // for look-up alone
};

}  // namespace samewhere::dense
