#include <algorithm>
#include <utility>

#include <samewhere/dense/scans.hpp>
#include <samewhere/dense/voxel.hpp>

namespace samewhere::dense {

std::vector<Eigen::Vector3f> thinned(const std::vector<Eigen::Vector3f>& points, double voxel_m) {
  std::vector<std::pair<VoxelKey, std::size_t>> order;
  order.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    order.emplace_back(voxel_of(points[i], voxel_m), i);
  }
  std::sort(order.begin(), order.end());
  std::vector<Eigen::Vector3f> kept;
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (i == 0 || order[i].first != order[i - 1].first) {
      kept.push_back(points[order[i].second]);
    }
  }
  return kept;
}

void Scans::add(const std::vector<SeenPoint>& points_of_one_view, const Eigen::Vector3d& camera_m) {
  if (num_views_++ % stride_views_ != 0) return;
  std::vector<Eigen::Vector3f> in_world;
  in_world.reserve(points_of_one_view.size());
  for (const SeenPoint& point : points_of_one_view) in_world.push_back(point.in_world);
  scans_.push_back({camera_m.cast<float>(), thinned(in_world, config_.grid_cell_m)});
  num_points_ += scans_.back().points_in_world.size();
  while (num_points_ > static_cast<std::size_t>(config_.max_scan_points) && scans_.size() > 1) {
    halve();
  }
}

void Scans::halve() {
  std::vector<Scan> kept;
  num_points_ = 0;
  for (std::size_t i = 0; i < scans_.size(); i += 2) {
    num_points_ += scans_[i].points_in_world.size();
    kept.push_back(std::move(scans_[i]));
  }
  scans_ = std::move(kept);
  stride_views_ *= 2;
}

}  // namespace samewhere::dense
