#include <sstream>

#include <gtest/gtest.h>
#include <octomap/OcTree.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/dense/octree_map.hpp>
#include <samewhere/dense/test_room.hpp>

namespace samewhere::dense {
namespace {

constexpr double kVoxel_m = 0.05;
const Config kOctreeConfig{.step_px = 1, .max_depth_m = 6.0, .octree_voxel_m = kVoxel_m};

octomap::point3d in_world(double x, double y, double z) {
  const Eigen::Vector3f point =
      (TestRoom::world_from_room() * Eigen::Vector3d(x, y, z)).cast<float>();
  return {point.x(), point.y(), point.z()};
}

TEST(OctreeMap, ItsLibraryReadsTheRoomBack) {
  OctreeMap map(kOctreeConfig);
  PointReader reader(kOctreeConfig);
  for (const View& view : TestRoom::walk()) {
    map.add(reader.points(view), view.world_from_camera.translation);
  }
  std::istringstream file(map.bt_bytes());
  octomap::OcTree tree(1.0);
  ASSERT_TRUE(tree.readBinary(file));
  EXPECT_DOUBLE_EQ(tree.getResolution(), kVoxel_m);

  double occupied_m3 = 0.0;
  const core::Rigid3 room_from_world = inverse(TestRoom::world_from_room());
  for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf) {
    if (!tree.isNodeOccupied(*leaf)) continue;
    occupied_m3 += std::pow(leaf.getSize(), 3);
    const Eigen::Vector3d center(leaf.getX(), leaf.getY(), leaf.getZ());
    EXPECT_LT(TestRoom::distance_m(room_from_world * center), leaf.getSize());
  }
  // floor, the lower part of the walls and the box, each one to two voxels thick
  const double seen_m2 = 4.0 * 3.0 + 14.0 * 1.4 + 4.0 * 0.6 * 0.8;
  EXPECT_GT(occupied_m3, 0.7 * seen_m2 * kVoxel_m);
  EXPECT_LT(occupied_m3, 2.5 * seen_m2 * kVoxel_m);

  const octomap::OcTreeNode* air = tree.search(in_world(2.0, 1.8, 1.0));
  ASSERT_NE(air, nullptr);
  EXPECT_FALSE(tree.isNodeOccupied(air));
  EXPECT_EQ(tree.search(in_world(2.9, 1.3, 0.4)), nullptr) << "no ray entered the box";
  EXPECT_EQ(tree.search(in_world(5.0, 1.0, 1.0)), nullptr) << "nor through the wall";
}

TEST(OctreeMap, ACameraBeyondItsReachIsRefused) {
  OctreeMap map(kOctreeConfig);
  try {
    map.add({}, {0.0, -1e4, 0.0});
    FAIL() << "it was taken";
  } catch (const core::InputError& error) {
    EXPECT_NE(std::string(error.what()).find("dense.octree_voxel_m"), std::string::npos);
  }
}

}  // namespace
}  // namespace samewhere::dense
