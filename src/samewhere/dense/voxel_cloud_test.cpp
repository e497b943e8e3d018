#include <algorithm>
#include <set>

#include <gtest/gtest.h>

#include <samewhere/core/random.hpp>
#include <samewhere/dense/test_room.hpp>
#include <samewhere/dense/voxel_cloud.hpp>

namespace samewhere::dense {
namespace {

SeenPoint at(float x, float y, float z, float depth_m = 1.0F) {
  return {.in_camera = {0.0F, 0.0F, depth_m}, .in_world = {x, y, z}, .rgb = {10, 20, 30}};
}

std::vector<CloudPoint> cloud_of_room(const Config& config) {
  PointReader reader(config);
  VoxelCloud cloud(config);
  for (const View& view : TestRoom::walk()) cloud.add(reader.points(view));
  return cloud.points();
}

TEST(VoxelCloud, AWalkThroughARoomGivesItsSurfaces) {
  const Config config{.step_px = 1, .max_depth_m = 6.0, .voxel_m = 0.1};
  const auto points = cloud_of_room(config);
  const core::Rigid3 room_from_world = inverse(TestRoom::world_from_room());
  double num_on_floor = 0;
  for (const auto& point : points) {
    const Eigen::Vector3d in_room =
        room_from_world * Eigen::Vector3d(point.in_world.cast<double>());
    EXPECT_LT(TestRoom::distance_m(in_room), 0.5 * config.voxel_m) << in_room.transpose();
    if (in_room.z() < 0.01) ++num_on_floor;
  }
  // a tilted plane cuts between one and two voxels per voxel's area
  const double floor_voxels = 4.0 * 3.0 / (config.voxel_m * config.voxel_m);
  EXPECT_GT(num_on_floor, 0.9 * floor_voxels);
  EXPECT_LT(num_on_floor, 2.0 * floor_voxels);
}

TEST(VoxelCloud, WhatWasSeenOnceIsNoPoint) {
  VoxelCloud cloud({.voxel_m = 0.1, .min_views = 2});
  cloud.add({at(0.05F, 0.05F, 0.05F), at(1.05F, 0.05F, 0.05F), at(1.06F, 0.05F, 0.05F)});
  EXPECT_TRUE(cloud.points().empty()) << "two points of one view are one sight";
  cloud.add({at(1.05F, 0.05F, 0.05F)});
  ASSERT_EQ(cloud.points().size(), 1U);
  EXPECT_NEAR(cloud.points()[0].in_world.x(), 1.053, 0.001);
}

TEST(VoxelCloud, NearSightWeighsByTheSquareOfDepth) {
  VoxelCloud cloud({.voxel_m = 0.1});
  cloud.add({at(0.02F, 0.05F, 0.05F, 1.0F)});
  cloud.add({at(0.07F, 0.05F, 0.05F, 2.0F)});
  EXPECT_NEAR(cloud.points().at(0).in_world.x(), (4.0 * 0.02 + 0.07) / 5.0, 1e-6);
}

TEST(VoxelCloud, MoreVoxelsThanTheMemoryHoldsBecomeCoarser) {
  constexpr std::uint64_t kSeed = 4;
  core::Random random(kSeed);
  const Config config{.voxel_m = 0.01, .max_voxels = 1000, .min_views = 1};
  VoxelCloud cloud(config);
  std::vector<SeenPoint> seen;
  for (int i = 0; i < 20000; ++i) {
    seen.push_back(at(static_cast<float>(random.uniform(-1.0, 1.0)),
                      static_cast<float>(random.uniform(-1.0, 1.0)), 0.0F));
  }
  cloud.add(seen);
  EXPECT_LE(cloud.points().size(), 1000U);
  EXPECT_GT(cloud.points().size(), 250U);
  EXPECT_DOUBLE_EQ(cloud.voxel_m(), 0.08) << "200^2, 100^2 and 50^2 are more than 1000, 25^2 not";
  std::set<VoxelKey> keys;
  for (const auto& point : cloud.points()) keys.insert(voxel_of(point.in_world, cloud.voxel_m()));
  EXPECT_EQ(keys.size(), cloud.points().size()) << "one point a voxel, on both sides of zero";
}

TEST(VoxelCloud, CoarserVoxelsKeepTheirViews) {
  VoxelCloud cloud({.voxel_m = 0.01, .max_voxels = 1000, .min_views = 2});
  cloud.add({at(0.005F, 0.005F, 0.005F)});
  cloud.add({at(0.015F, 0.005F, 0.005F)});
  EXPECT_TRUE(cloud.points().empty());
  std::vector<SeenPoint> far;
  for (int i = 0; i < 1200; ++i) far.push_back(at(1.005F + 0.01F * static_cast<float>(i), 0, 0));
  cloud.add(far);
  ASSERT_EQ(cloud.points().size(), 1U) << "its halves were seen once each, the far ones once";
  EXPECT_NEAR(cloud.points()[0].in_world.x(), 0.01, 1e-6);
}

TEST(VoxelCloud, TheOrderOfPointsInAViewChangesNoVoxel) {
  constexpr std::uint64_t kSeed = 5;
  core::Random random(kSeed);
  std::vector<SeenPoint> seen;
  for (int i = 0; i < 500; ++i) {
    const auto x = static_cast<float>(i);
    seen.push_back(at(x, static_cast<float>(random.uniform(-9.0, 9.0)), 0.0F));
  }
  const auto points_of = [](const std::vector<SeenPoint>& view) {
    VoxelCloud cloud({.min_views = 1});
    cloud.add(view);
    return cloud.points();
  };
  const auto forwards = points_of(seen);
  std::reverse(seen.begin(), seen.end());
  const auto backwards = points_of(seen);
  ASSERT_EQ(forwards.size(), backwards.size());
  for (std::size_t i = 0; i < forwards.size(); ++i) {
    EXPECT_EQ(forwards[i].in_world, backwards[i].in_world) << "seed " << kSeed;
  }
}

}  // namespace
}  // namespace samewhere::dense
