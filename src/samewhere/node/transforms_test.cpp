#include <gtest/gtest.h>

#include <samewhere/node/live_frames.hpp>
#include <samewhere/node/test_messages.hpp>

namespace samewhere::node {
namespace {

constexpr double kPoseTolerance = 1e-12;

Pose some_pose(int seed) {
  const double s = seed;
  Pose pose = Pose::Identity();
  pose.linear() =
      Eigen::AngleAxisd(0.3 * s, Eigen::Vector3d(1.0, s, -0.5 * s).normalized()).toRotationMatrix();
  pose.translation() << s, -2.0 * s, 0.5 + s;
  return pose;
}

void expect_same(const Pose& one, const Pose& other) {
  EXPECT_LT((one.matrix() - other.matrix()).norm(), kPoseTolerance);
}

TEST(Transforms, AMessageComesBackAsThePose) {
  for (int seed = 1; seed < 30; ++seed) {
    const auto message = transform_message("map", "odom", 12.5, some_pose(seed));
    const auto pose = pose_from(message.transform.translation, message.transform.rotation);
    ASSERT_TRUE(pose);
    expect_same(*pose, some_pose(seed));
    EXPECT_EQ(messages::seconds(message.header.stamp), 12.5);
  }
}

// REP-103: what the camera sees ahead is ahead of the robot, what is right in the image has y < 0.
TEST(Transforms, OpticalAxesAreThoseOfTheRobotTurned) {
  const Pose pose = body_from_optical();
  EXPECT_EQ(pose * Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(1, 0, 0));
  EXPECT_EQ(pose * Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, -1, 0));
  EXPECT_EQ(pose * Eigen::Vector3d(0, 1, 0), Eigen::Vector3d(0, 0, -1));
}

Tracked tracked_at(int seed, const Pose& map_from_odom) {
  return {.status = Status::kTracking,
          .odom_from_camera = some_pose(seed),
          .map_from_odom = map_from_odom};
}

TEST(LiveFrames, TheChainIsThePoseOfTheBaseInTheMap) {
  LiveFrames frames;
  const Pose camera_from_base = some_pose(4);
  for (int seed = 1; seed < 20; ++seed) {
    const Tracked tracked = tracked_at(seed, some_pose(20 - seed));
    frames.update(tracked, camera_from_base);
    expect_same(frames.map_from_odom() * frames.odom_from_base() * camera_from_base.inverse(),
                tracked.map_from_camera());
  }
}

TEST(LiveFrames, OdometryGoesOnWhereAnotherSessionBegins) {
  LiveFrames frames;
  const Pose camera_from_base = some_pose(4);
  frames.update(tracked_at(3, some_pose(1)), camera_from_base);
  const Pose last = frames.odom_from_base();
  frames.begin_session();
  const Tracked first = tracked_at(0, Pose::Identity());
  frames.update(first, camera_from_base);
  expect_same(frames.odom_from_base(), last);
  expect_same(frames.map_from_base(), first.map_from_camera() * camera_from_base);
  const Tracked second = tracked_at(5, some_pose(6));
  frames.update(second, camera_from_base);
  expect_same(frames.map_from_base(), second.map_from_camera() * camera_from_base);
}

TEST(LiveFrames, OdometryFromElsewhereLeavesThePoseInTheMap) {
  LiveFrames frames;
  frames.update(tracked_at(3, some_pose(1)), some_pose(4));
  const Pose map_from_base = frames.map_from_base();
  frames.use_odometry(some_pose(7));
  expect_same(frames.odom_from_base(), some_pose(7));
  expect_same(frames.map_from_odom() * some_pose(7), map_from_base);
}

TEST(OdometryBuffer, InterpolatesBetweenItsStampsAlone) {
  OdometryBuffer buffer;
  Pose pose = Pose::Identity();
  EXPECT_TRUE(buffer.is_empty());
  for (int i = 0; i < 3; ++i) {
    pose.translation().x() = i;
    buffer.add(i, pose);
  }
  EXPECT_NEAR(buffer.at(0.25)->translation().x(), 0.25, kPoseTolerance);
  EXPECT_EQ(buffer.at(2.0)->translation().x(), 2.0);
  EXPECT_FALSE(buffer.at(2.01));
  EXPECT_FALSE(buffer.at(-0.01));
  buffer.add(1.5, Pose::Identity());
  EXPECT_EQ(buffer.at(2.0)->translation().x(), 2.0) << "what is late is left out";
  buffer.add(0.5, Pose::Identity());
  EXPECT_FALSE(buffer.at(2.0)) << "a step back begins again";
}

}  // namespace
}  // namespace samewhere::node
