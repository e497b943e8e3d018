#pragma once

#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <samewhere/dense/config.hpp>
#include <samewhere/dense/view.hpp>

namespace samewhere::dense {

// Throws InputError that names the option if the program was built without dense maps, that is
// without OctoMap (-DSAMEWHERE_DENSE=OFF).
void require_dense_maps();

// Free, occupied and unknown space in 3D: the OctoMap of Hornung et al. (Autonomous Robots 2013),
// by its library.
class OctreeMap {
 public:
  // Throws InputError as require_dense_maps().
  explicit OctreeMap(const Config& config);
  OctreeMap(const OctreeMap&) = delete;
  OctreeMap& operator=(const OctreeMap&) = delete;
  ~OctreeMap();

  // Throws InputError if the camera is so far from the world's origin that the tree does not reach
  // there.
  void add(const std::vector<SeenPoint>& points_of_one_view, const Eigen::Vector3d& camera_m);

  // A file of OctoMap's binary kind (.bt): each voxel free or occupied, whichever is likelier. The
  // map is simplified by that; nothing can be added afterwards.
  std::string bt_bytes();

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace samewhere::dense
