#include <algorithm>

#include <gtest/gtest.h>

#include <samewhere/node/keyframe_depths.hpp>
#include <samewhere/node/test_messages.hpp>

namespace samewhere::node {
namespace {

core::PinholeRadtan small_camera() {
  return {
      .width_px = 80, .height_px = 60, .fx_px = 60.0, .fy_px = 60.0, .cx_px = 39.5, .cy_px = 29.5};
}

KeyframeInserted keyframe_at(std::uint64_t id, double stamp_s) {
  return {.keyframe = id, .frame = {}, .stamp_s = stamp_s};
}

TEST(KeyframeDepths, KeepsTheDepthOfKeyframesAlone) {
  KeyframeDepths depths({}, small_camera());
  for (const double stamp_s : {1.0, 1.1, 1.2})
    depths.take_frame(stamp_s, cv::Mat(60, 80, CV_32F, cv::Scalar(2.0 * stamp_s)));
  depths.take_keyframe(keyframe_at(7, 1.1));
  depths.take_keyframe(keyframe_at(8, 0.5));  // a frame that was not given
  ASSERT_EQ(depths.all().size(), 1U);
  EXPECT_EQ(depths.all()[0]->keyframe, 7U);
  ASSERT_GT(depths.all()[0]->points_in_camera.size(), 100U);
  for (const Eigen::Vector3f& point : depths.all()[0]->points_in_camera)
    EXPECT_FLOAT_EQ(point.z(), 2.2F);
  depths.clear();
  EXPECT_TRUE(depths.all().empty());
}

TEST(KeyframeDepths, MemoryIsBounded) {
  KeyframeDepths depths({.max_scan_points = 10000}, small_camera());
  for (std::uint64_t i = 0; i < 100; ++i) {
    depths.take_frame(static_cast<double>(i), cv::Mat(60, 80, CV_32F, cv::Scalar(2.0)));
    depths.take_keyframe(keyframe_at(i, static_cast<double>(i)));
  }
  std::size_t num_points = 0;
  for (const auto& depth : depths.all()) num_points += depth->points_in_camera.size();
  EXPECT_LE(num_points, 10000U);
  EXPECT_GT(num_points, 3000U);
  EXPECT_EQ(depths.all().back()->keyframe, 99U) << "the newest stays";
}

// A rendered walk through corridors: the floor that the camera walked over is free, walls are
// there.
TEST(Node, GivesAnOccupancyGridOfDepth) {
  TestPublisher publisher;
  Node node(test_node_config(), test_node_options(), publisher);
  play(node, MessageWalk());
  node.finish();
  ASSERT_FALSE(publisher.of_grids.empty());
  const messages::OccupancyGrid& grid = publisher.of_grids.back();
  EXPECT_EQ(grid.header.frame_id, "map");
  const auto num_of = [&](int value) {
    return std::count(grid.data.begin(), grid.data.end(), value);
  };
  const double cell_m2 = static_cast<double>(grid.info.resolution) * grid.info.resolution;
  EXPECT_GT(static_cast<double>(num_of(0)) * cell_m2, 2.0) << "free, square metres";
  EXPECT_GT(num_of(100), 20);
  EXPECT_LT(grid.info.origin.position.z, -0.5) << "the floor is below the first camera";
}

TEST(Node, GivesNoGridIfNoneIsWanted) {
  TestPublisher publisher;
  Config config = test_node_config();
  config.grid_period_s = 0.0;
  Node node(config, test_node_options(), publisher);
  play(node, MessageWalk());
  node.finish();
  EXPECT_TRUE(publisher.of_grids.empty());
}

}  // namespace
}  // namespace samewhere::node
