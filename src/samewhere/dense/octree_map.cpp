#include <sstream>

#include <fmt/format.h>
#include <octomap/OcTree.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/dense/octree_map.hpp>

namespace samewhere::dense {
namespace {

constexpr double kHalfWidth_voxels = 32768.0;  // of a tree with 16 levels

}  // namespace

void require_dense_maps() {}

struct OctreeMap::Tree {
  Tree(double voxel_m, double max_depth_m)
      : octree(voxel_m), max_reach_m(kHalfWidth_voxels * voxel_m - 2.0 * max_depth_m) {}

  octomap::OcTree octree;
  double max_reach_m;  // of a camera, such that all that it sees lies in the tree
};

OctreeMap::OctreeMap(const Config& config)
    : tree_(std::make_unique<Tree>(config.octree_voxel_m, config.max_depth_m)) {}

OctreeMap::~OctreeMap() = default;

void OctreeMap::add(const std::vector<SeenPoint>& points_of_one_view,
                    const Eigen::Vector3d& camera_m) {
  if (!(camera_m.cwiseAbs().maxCoeff() < tree_->max_reach_m)) {
    throw core::InputError(fmt::format(
        "a camera at ({:.1f}, {:.1f}, {:.1f}) m, expected within {:.0f} m of the origin: an octree "
        "of voxels of dense.octree_voxel_m = {} m reaches no farther",
        camera_m.x(), camera_m.y(), camera_m.z(), tree_->max_reach_m,
        tree_->octree.getResolution()));
  }
  octomap::Pointcloud cloud;
  cloud.reserve(points_of_one_view.size());
  for (const SeenPoint& point : points_of_one_view) {
    cloud.push_back(point.in_world.x(), point.in_world.y(), point.in_world.z());
  }
  const Eigen::Vector3f origin = camera_m.cast<float>();
  // depth was limited before; inner nodes are brought up to date once, at the end; one ray a voxel
  constexpr double kNoLimit_m = -1.0;
  constexpr bool kIsLazy = true;
  constexpr bool kIsThinned = true;
  tree_->octree.insertPointCloud(cloud, {origin.x(), origin.y(), origin.z()}, kNoLimit_m, kIsLazy,
                                 kIsThinned);
}

std::string OctreeMap::bt_bytes() {
  octomap::OcTree& octree = tree_->octree;
  octree.updateInnerOccupancy();
  octree.toMaxLikelihood();
  octree.prune();
  // the library's writeBinary, without the lines that it prints on stderr
  std::ostringstream bytes;
  bytes << fmt::format("# Octomap OcTree binary file\nid {}\nsize {}\nres {}\ndata\n",
                       octree.getTreeType(), octree.size(), octree.getResolution());
  octree.writeBinaryData(bytes);
  return std::move(bytes).str();
}

}  // namespace samewhere::dense
