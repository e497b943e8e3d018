#include <algorithm>
#include <cmath>

#include <samewhere/dense/voxel_cloud.hpp>

namespace samewhere::dense {

VoxelCloud::VoxelCloud(const Config& config) : config_(config), voxel_m_(config.voxel_m) {}

void VoxelCloud::add(const std::vector<SeenPoint>& points_of_one_view) {
  for (const SeenPoint& point : points_of_one_view) {
    const float depth_m = point.in_camera.z();
    put({.key = voxel_of(point.in_world, voxel_m_),
         .weight = 1.0F / (depth_m * depth_m),
         .position_m = point.in_world,
         .rgb = Eigen::Vector3f(point.rgb[0], point.rgb[1], point.rgb[2]),
         .last_view = num_views_,
         .num_views = 1});
    if (voxels_.size() > static_cast<std::size_t>(config_.max_voxels)) double_edge();
  }
  ++num_views_;
}

void VoxelCloud::put(const Voxel& voxel) {
  const auto [entry, is_new] =
      index_of_.try_emplace(voxel.key, static_cast<std::uint32_t>(voxels_.size()));
  if (is_new) {
    voxels_.push_back(voxel);
  } else {
    blend(voxels_[entry->second], voxel);
  }
}

void VoxelCloud::blend(Voxel& voxel, const Voxel& more) {
  const float share = more.weight / (voxel.weight + more.weight);
  voxel.weight += more.weight;
  voxel.position_m += share * (more.position_m - voxel.position_m);
  voxel.rgb += share * (more.rgb - voxel.rgb);
  // whichever ended later has a view that the other cannot have
  if (voxel.last_view < more.last_view) {
    voxel.num_views = std::max(voxel.num_views + 1, more.num_views);
  } else if (voxel.last_view > more.last_view) {
    voxel.num_views = std::max(voxel.num_views, more.num_views + 1);
  } else {
    voxel.num_views = std::max(voxel.num_views, more.num_views);
  }
  voxel.last_view = std::max(voxel.last_view, more.last_view);
}

void VoxelCloud::double_edge() {
  std::vector<Voxel> finer;
  finer.swap(voxels_);
  index_of_.clear();
  voxel_m_ *= 2.0;
  for (Voxel& voxel : finer) {
    voxel.key = parent_of(voxel.key);
    put(voxel);
  }
}

std::vector<CloudPoint> VoxelCloud::points() const {
  std::vector<const Voxel*> kept;
  for (const Voxel& voxel : voxels_) {
    if (voxel.num_views >= config_.min_views) kept.push_back(&voxel);
  }
  std::sort(kept.begin(), kept.end(),
            [](const Voxel* a, const Voxel* b) { return a->key < b->key; });
  std::vector<CloudPoint> points;
  points.reserve(kept.size());
  for (const Voxel* voxel : kept) {
    CloudPoint point{.in_world = voxel->position_m};
    for (int c = 0; c < 3; ++c) {
      point.rgb[static_cast<std::size_t>(c)] =
          static_cast<std::uint8_t>(std::lround(std::clamp(voxel->rgb[c], 0.0F, 255.0F)));
    }
    points.push_back(point);
  }
  return points;
}

}  // namespace samewhere::dense
