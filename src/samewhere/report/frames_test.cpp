#include <gtest/gtest.h>

#include <samewhere/report/frames.hpp>

namespace samewhere::report {
namespace {

FrameRecord frame(std::uint64_t index, core::FrameStatus status, double x_m) {
  FrameRecord record;
  record.pose.frame = core::FrameId(index);
  record.pose.stamp_s = static_cast<double>(index);
  record.pose.status = status;
  record.pose.is_measured = status != core::FrameStatus::kLost;
  record.name = "a, b.png";
  if (record.pose.is_measured)
    record.world_from_camera = core::Rigid3{Eigen::Quaterniond::Identity(), {x_m, 0.0, 0.0}};
  return record;
}

const std::vector<FrameRecord> kFrames = {
    frame(0, core::FrameStatus::kTracking, 1.0), frame(1, core::FrameStatus::kLost, 0.0),
    frame(2, core::FrameStatus::kProvisional, 2.0), frame(3, core::FrameStatus::kResumed, 3.0)};

TEST(Frames, AProvisionalPoseIsNotInTheTrajectory) {
  const core::Trajectory trajectory = measured_trajectory(kFrames);
  ASSERT_EQ(trajectory.size(), 2U);
  EXPECT_EQ(trajectory[1].stamp_s, 3.0);
}

TEST(Frames, AProvisionalPoseIsShownWithItsStatus) {
  const std::string csv = frames_csv(kFrames);
  EXPECT_NE(csv.find("provisional,0,0,,2.000000000,"), std::string::npos) << csv;
  EXPECT_NE(csv.find("tracking,1,0,,1.000000000,"), std::string::npos) << csv;
}

TEST(Frames, NewPosesAreThoseOfTheTrajectory) {
  core::Trajectory trajectory = measured_trajectory(kFrames);
  for (auto& pose : trajectory) pose.world_from_camera.translation.y() = 7.0;
  const std::string csv = with_poses(frames_csv(kFrames), trajectory);
  EXPECT_NE(csv.find("1.000000000,7.000000000,"), std::string::npos) << csv;
  EXPECT_NE(csv.find("2.000000000,0.000000000,"), std::string::npos) << "the provisional one stays";
  EXPECT_NE(csv.find("3.000000000,7.000000000,"), std::string::npos) << csv;
}

}  // namespace
}  // namespace samewhere::report
