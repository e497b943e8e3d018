#include <numbers>

#include <gtest/gtest.h>

#include <samewhere/twin/office_loop.hpp>

namespace samewhere::twin {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

Eigen::Vector3d forward_of(const core::StampedPose& pose) {
  return pose.world_from_camera.rotation * Eigen::Vector3d::UnitZ();
}

class OfficeWalk : public testing::TestWithParam<std::uint64_t> {
 protected:
  core::Trajectory walk_ = office_loop_walk(GetParam());
};

TEST_P(OfficeWalk, TakesAboutSixHundredFramesAtFifteenASecond) {
  EXPECT_GT(walk_.size(), 560U);
  EXPECT_LT(walk_.size(), 660U);
  for (std::size_t i = 0; i < walk_.size(); ++i) {
    EXPECT_DOUBLE_EQ(walk_[i].stamp_s, static_cast<double>(i) / 15.0);
  }
}

TEST_P(OfficeWalk, RotationsAreProperAndLevel) {
  for (const auto& pose : walk_) {
    EXPECT_NEAR(pose.world_from_camera.rotation.norm(), 1.0, 1e-12);
    const Eigen::Matrix3d rotation = pose.world_from_camera.rotation.toRotationMatrix();
    EXPECT_NEAR(rotation.determinant(), 1.0, 1e-9);
    EXPECT_LT(rotation(2, 1), -0.95) << "y of the camera points down";
  }
}

TEST_P(OfficeWalk, MovesSmoothlyAtWalkingPace) {
  for (std::size_t i = 2; i < walk_.size(); ++i) {
    const core::Rigid3& a = walk_[i - 2].world_from_camera;
    const core::Rigid3& b = walk_[i - 1].world_from_camera;
    const core::Rigid3& c = walk_[i].world_from_camera;
    const double speed_m_s = 15.0 * (c.translation - b.translation).norm();
    ASSERT_GT(speed_m_s, 0.5) << "frame " << i;
    ASSERT_LT(speed_m_s, 1.7) << "frame " << i;
    ASSERT_LT((c.translation - 2.0 * b.translation + a.translation).norm(), 0.02) << "frame " << i;
    const Eigen::Quaterniond turn = b.rotation.conjugate() * c.rotation;
    const Eigen::Quaterniond turn_before = a.rotation.conjugate() * b.rotation;
    ASSERT_LT(core::angle_rad(turn), 4.0 * kDegree) << "frame " << i;
    ASSERT_LT(core::angle_rad(turn_before.conjugate() * turn), 0.6 * kDegree) << "frame " << i;
  }
}

TEST_P(OfficeWalk, StaysClearOfTheWalls) {
  for (const auto& pose : walk_) {
    const Eigen::Vector3d& p = pose.world_from_camera.translation;
    const double to_outside_m = std::min(8.0 - std::abs(p.x()), 5.0 - std::abs(p.y()));
    const double from_block_m = std::max(std::abs(p.x()) - 6.0, std::abs(p.y()) - 3.0);
    EXPECT_GT(to_outside_m, 0.5);
    EXPECT_GT(from_block_m, 0.5);
    EXPECT_NEAR(p.z(), 1.5, 0.1);
  }
}

TEST_P(OfficeWalk, EndsInTheSecondLapLookingTheSameWay) {
  const core::StampedPose& last = walk_.back();
  double nearest_m = 1e9;
  double turn_rad = 1e9;
  for (std::size_t i = 0; i + 300 < walk_.size(); ++i) {
    const double distance_m =
        (walk_[i].world_from_camera.translation - last.world_from_camera.translation).norm();
    if (distance_m >= nearest_m) continue;
    nearest_m = distance_m;
    turn_rad = std::acos(std::min(1.0, forward_of(walk_[i]).dot(forward_of(last))));
  }
  EXPECT_LT(nearest_m, 0.6);
  EXPECT_LT(turn_rad, 30.0 * kDegree);
  EXPECT_GT(
      (last.world_from_camera.translation - walk_.front().world_from_camera.translation).norm(),
      6.0);
}

INSTANTIATE_TEST_SUITE_P(Seeds, OfficeWalk, testing::Values(0, 1, 2, 3, 4, 5, 6, 7));

TEST(OfficeWalkSeed, ChangesTheMotion) {
  const auto first = office_loop_walk(1);
  const auto second = office_loop_walk(2);
  EXPECT_GT(
      (first[100].world_from_camera.translation - second[100].world_from_camera.translation).norm(),
      0.01);
}

}  // namespace
}  // namespace samewhere::twin
