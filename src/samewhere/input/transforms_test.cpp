#include <limits>

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

core::Rigid3 pose_number(int number) {
  const double n = number;
  core::Vector6d tangent;
  tangent << n, -2.0 * n, 0.5 + n, 0.3 * n, 0.1 - 0.2 * n, 0.05 * n;
  return core::exp_r3so3(tangent);
}

messages::TransformStamped link(const char* parent, const char* child, const core::Rigid3& pose) {
  messages::TransformStamped transform = link(parent, child, 0.0);
  transform.transform = transform_of(pose);
  return transform;
}

void expect_same(const core::Rigid3& one, const core::Rigid3& other) {
  EXPECT_LT((one.matrix() - other.matrix()).norm(), 1e-12);
}

TEST(RigidTransform, ComesBackFromItsMessage) {
  for (int number = 1; number < 30; ++number) {
    const messages::Transform message = transform_of(pose_number(number));
    const auto pose = rigid_from(message.translation, message.rotation);
    ASSERT_TRUE(pose) << number;
    expect_same(*pose, pose_number(number));
  }
}

TEST(RigidTransform, IsNotMadeOfWhatIsNoRotation) {
  EXPECT_FALSE(rigid_from({}, {0.0, 0.0, 0.0, 0.0}));
  EXPECT_FALSE(rigid_from({}, {0.0, 0.0, 0.0, 2.0}));
  EXPECT_FALSE(rigid_from({std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0}, {}));
  const auto rounded = rigid_from({}, {0.0, 0.0, 0.0, 1.05});
  ASSERT_TRUE(rounded);
  EXPECT_DOUBLE_EQ(rounded->rotation.norm(), 1.0);
}

TEST(Transforms, FindFixedFramesThroughACommonOne) {
  Transforms transforms;
  transforms.add(link("base", "camera", 1.0), true);
  transforms.add(link("base", "imu", 3.0), true);
  transforms.add(link("camera", "optical", 0.5), true);
  ASSERT_TRUE(transforms.fixed("optical", "imu"));
  EXPECT_DOUBLE_EQ(transforms.fixed("optical", "imu")->translation.x(), 1.5);
  EXPECT_TRUE(transforms.fixed("unknown", "unknown"));
  EXPECT_FALSE(transforms.fixed("camera", "unknown"));
}

TEST(Transforms, ChainRotationsToo) {
  Transforms transforms;
  transforms.add(link("base", "mast", pose_number(1)), true);
  transforms.add(link("mast", "camera", pose_number(2)), true);
  transforms.add(link("base", "laser", pose_number(3)), true);
  const core::Rigid3 base_from_camera = pose_number(1) * pose_number(2);
  expect_same(*transforms.fixed("base", "camera"), base_from_camera);
  expect_same(*transforms.fixed("camera", "base"), core::inverse(base_from_camera));
  expect_same(*transforms.fixed("laser", "camera"),
              core::inverse(pose_number(3)) * base_from_camera);
}

TEST(Transforms, NamesOfRos1MayBeginWithASlash) {
  Transforms transforms;
  transforms.add(link("/base", "mast", 1.0), true);
  transforms.add(link("mast", "/camera", 0.5), true);
  EXPECT_DOUBLE_EQ(transforms.fixed("base", "camera")->translation.x(), 1.5);
  EXPECT_DOUBLE_EQ(transforms.fixed("/base", "/camera")->translation.x(), 1.5);
  EXPECT_EQ(transforms.fixed_root_of("/camera").name, "base");
}

TEST(Transforms, TheRootIsTheTopOfWhatIsFixed) {
  Transforms transforms;
  transforms.add(link("odom", "base", 7.0, 1.0), false);
  transforms.add(link("base", "mast", pose_number(1)), true);
  transforms.add(link("mast", "camera", pose_number(2)), true);
  const Transforms::Root root = transforms.fixed_root_of("camera");
  EXPECT_EQ(root.name, "base");
  expect_same(root.root_from_frame, pose_number(1) * pose_number(2));
  EXPECT_EQ(transforms.fixed_root_of("gripper").name, "gripper");
}

TEST(Transforms, WhatMovesIsNotFixed) {
  Transforms transforms;
  transforms.add(link("map", "base", 1.0, 0.0), false);
  transforms.add(link("base", "camera", 0.1), true);
  EXPECT_FALSE(transforms.fixed("map", "camera"));
  EXPECT_TRUE(transforms.fixed("base", "camera"));
}

TEST(Transforms, ALaterFixedOneReplacesTheEarlier) {
  Transforms transforms;
  transforms.add(link("base", "camera", 1.0), true);
  EXPECT_TRUE(transforms.add(link("base", "camera", 2.0), true));
  EXPECT_DOUBLE_EQ(transforms.fixed("base", "camera")->translation.x(), 2.0);
  EXPECT_TRUE(transforms.add(link("mast", "camera", 3.0), true));
  EXPECT_FALSE(transforms.fixed("base", "camera"));
  EXPECT_DOUBLE_EQ(transforms.fixed("mast", "camera")->translation.x(), 3.0);
}

TEST(Transforms, AFrameThatMovesKeepsItsParent) {
  Transforms transforms;
  EXPECT_TRUE(transforms.add(link("odom", "base", 1.0, 1.0), false));
  EXPECT_FALSE(transforms.add(link("truth", "base", 9.0, 2.0), false));
  EXPECT_FALSE(transforms.add(link("odom", "base", 9.0), true));
  const core::Trajectory trajectory = transforms.trajectory_of("base");
  ASSERT_EQ(trajectory.size(), 1U);
  EXPECT_DOUBLE_EQ(trajectory[0].world_from_camera.translation.x(), 1.0);
}

TEST(Transforms, WhatWasFixedAndMovesHasNoPoseBefore) {
  Transforms transforms;
  transforms.add(link("odom", "base", 9.0), true);
  transforms.add(link("odom", "base", 1.0, 5.0), false);
  const core::Trajectory trajectory = transforms.trajectory_of("base");
  ASSERT_EQ(trajectory.size(), 1U);
  EXPECT_DOUBLE_EQ(trajectory[0].stamp_s, 5.0);
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

TEST(Transforms, RingsAreLeftOut) {
  Transforms transforms;
  EXPECT_FALSE(transforms.add(link("a", "a", 1.0), true));
  EXPECT_TRUE(transforms.add(link("a", "b", 1.0), true));
  EXPECT_TRUE(transforms.add(link("b", "c", 2.0), false));
  EXPECT_FALSE(transforms.add(link("c", "b", 3.0), true));
  EXPECT_FALSE(transforms.add(link("c", "/a", 3.0), false));
  EXPECT_EQ(transforms.fixed_root_of("b").name, "a");
  EXPECT_EQ(transforms.trajectory_of("c").size(), 1U);
}

TEST(Transforms, WhatIsNotRigidOrHasNoNameIsLeftOut) {
  Transforms transforms;
  messages::TransformStamped none = link("a", "b", 1.0);
  none.transform.rotation.w = 0.0;
  EXPECT_FALSE(transforms.add(none, true));
  EXPECT_FALSE(transforms.fixed("a", "b"));
  EXPECT_FALSE(transforms.add(link("", "b", 1.0), true));
  EXPECT_FALSE(transforms.add(link("a", "/", 1.0), true));
}

}  // namespace
}  // namespace samewhere::input
