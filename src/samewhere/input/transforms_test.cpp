#include <gtest/gtest.h>

#include <samewhere/input/transforms.hpp>

namespace samewhere::input {
namespace {

messages::TransformStamped link(const char* parent, const char* child, double x_m,
                                double stamp_s = 0.0) {
  messages::TransformStamped transform;
  transform.header = {.stamp = messages::time_of(stamp_s), .frame_id = parent};
  transform.child_frame_id = child;
  transform.transform.translation.x = x_m;
  return transform;
}

TEST(Transforms, FindFixedFramesThroughACommonOne) {
  Transforms transforms;
  transforms.add(link("base", "camera", 1.0), true);
  transforms.add(link("base", "imu", 3.0), true);
  transforms.add(link("camera", "optical", 0.5), true);
  ASSERT_TRUE(transforms.fixed("optical", "imu"));
  EXPECT_DOUBLE_EQ(transforms.fixed("optical", "imu")->translation.x(), 1.5);
  EXPECT_DOUBLE_EQ(transforms.fixed("/imu", "/optical")->translation.x(), -1.5);
  EXPECT_TRUE(transforms.fixed("unknown", "unknown"));
  EXPECT_FALSE(transforms.fixed("camera", "unknown"));
}

TEST(Transforms, WhatMovesIsNotFixed) {
  Transforms transforms;
  transforms.add(link("map", "base", 1.0, 0.0), false);
  transforms.add(link("base", "camera", 0.1), true);
  EXPECT_FALSE(transforms.fixed("map", "camera"));
  EXPECT_TRUE(transforms.fixed("base", "camera"));
}

TEST(Transforms, GiveTheTrajectoryOfAFrameFromItsRoot) {
  Transforms transforms;
  for (int i = 0; i < 5; ++i) transforms.add(link("odom", "base", i, i), false);
  transforms.add(link("map", "odom", 10.0, 0.0), false);
  transforms.add(link("map", "odom", 20.0, 4.0), false);
  transforms.add(link("base", "camera", 0.5), true);
  const core::Trajectory trajectory = transforms.trajectory_of("camera");
  ASSERT_EQ(trajectory.size(), 5U);
  EXPECT_DOUBLE_EQ(trajectory[2].stamp_s, 2.0);
  EXPECT_DOUBLE_EQ(trajectory[2].world_from_camera.translation.x(), 15.0 + 2.0 + 0.5);
  EXPECT_TRUE(transforms.trajectory_of("unknown").empty());
}

TEST(Transforms, ACircleOfFramesEnds) {
  Transforms transforms;
  transforms.add(link("a", "b", 1.0), true);
  transforms.add(link("b", "a", 1.0), true);
  transforms.fixed("a", "b");
  EXPECT_TRUE(transforms.trajectory_of("a").empty());
}

TEST(Transforms, WhatIsNoRotationIsPassedOver) {
  Transforms transforms;
  messages::TransformStamped none = link("a", "b", 1.0);
  none.transform.rotation.w = 0.0;
  transforms.add(none, true);
  EXPECT_FALSE(transforms.fixed("a", "b"));
}

}  // namespace
}  // namespace samewhere::input
