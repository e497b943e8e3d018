#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include <samewhere/dense/config.hpp>
#include <samewhere/dense/view.hpp>

namespace samewhere::dense {

// What one view saw, thinned to a point per voxel.
struct Scan {
  Eigen::Vector3f camera_in_world = Eigen::Vector3f::Zero();
  std::vector<Eigen::Vector3f> points_in_world;
};

// The first point of each voxel, ordered by voxel.
std::vector<Eigen::Vector3f> thinned(const std::vector<Eigen::Vector3f>& points, double voxel_m);

// The scans of a walk, kept until it is known where the floor is. Holds at most
// config.max_scan_points points: when there are more, every other scan goes and only every other
// view is kept from then on.
class Scans {
 public:
  explicit Scans(const Config& config) : config_(config) {}

  void add(const std::vector<SeenPoint>& points_of_one_view, const Eigen::Vector3d& camera_m);
  const std::vector<Scan>& all() const { return scans_; }
  // One of so many views was kept.
  std::size_t stride_views() const { return stride_views_; }

 private:
  void halve();

  Config config_;
  std::vector<Scan> scans_;
  std::size_t num_views_ = 0;
  std::size_t num_points_ = 0;
  std::size_t stride_views_ = 1;
};

}  // namespace samewhere::dense
