// What stands for octree_map.cpp in a build without OctoMap (-DSAMEWHERE_DENSE=OFF).
#include <samewhere/core/errors.hpp>
#include <samewhere/dense/octree_map.hpp>

namespace samewhere::dense {

void require_dense_maps() {
  throw core::InputError(
      "dense: built without dense maps (SAMEWHERE_DENSE=OFF), expected a build with "
      "-DSAMEWHERE_DENSE=ON");
}

struct OctreeMap::Tree {};

OctreeMap::OctreeMap(const Config& /*config*/) { require_dense_maps(); }

OctreeMap::~OctreeMap() = default;

void OctreeMap::add(const std::vector<SeenPoint>& /*points_of_one_view*/,
                    const Eigen::Vector3d& /*camera_m*/) {}

std::string OctreeMap::bt_bytes() { return {}; }

}  // namespace samewhere::dense
