#include <gtest/gtest.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/tum_file.hpp>
#include <samewhere/input/test_folder.hpp>
#include <samewhere/node/trajectory_file.hpp>

namespace samewhere::node {
namespace {

TEST(TrajectoryFile, IsThatOfTum) {
  const input::TestFolder folder;
  Pose pose = Pose::Identity();
  pose.translation() << 1.0, -2.0, 0.5;
  pose.rotate(Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ()));
  write_trajectory(folder.at("a.tum"), {{12.5, Pose::Identity()}, {13.0, pose}});
  const core::Trajectory back = core::read_tum(folder.at("a.tum"));
  ASSERT_EQ(back.size(), 2U);
  EXPECT_EQ(back[1].stamp_s, 13.0);
  EXPECT_LT((back[1].world_from_camera.matrix() - pose.matrix()).norm(), 1e-8);
  EXPECT_THROW(write_trajectory(folder.root() / "none" / "a.tum", {}), core::InputError);
}

}  // namespace
}  // namespace samewhere::node
