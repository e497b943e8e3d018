#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <samewhere/input/test_recording.hpp>

namespace samewhere::input {
namespace {

using testing::HasSubstr;

class Rawseeds : public Open {
 protected:
  Rawseeds() {
    for (const char* stamp : {"1235604664.906455", "1235604664.973121", "1235604665.000121"})
      folder_.write_png("FRONTAL/FRONTAL_" + std::string(stamp) + ".png", picture(32, 24));
    folder_.write("Bicocca_2009-02-25b-GROUNDTRUTH.csv",
                  "1235604664.9,1.0,2.0,0.0,0.1,0,0,0,0.1,0,0,0,0.1\n"
                  "1235604665.1,1.5,2.0,1.57079632679,0.1,0,0,0,0.1,0,0,0,0.1\n");
  }
};

TEST_F(Rawseeds, StampsAreInTheNames) {
  EXPECT_EQ(open()->info().format, "Rawseeds");
  const std::vector<core::Frame> frames = read_all();
  ASSERT_EQ(frames.size(), 3U);
  EXPECT_NEAR(frames[0].stamp_s, 1235604664.906455, 1e-6);
  EXPECT_NEAR(frames[2].stamp_s, 1235604665.000121, 1e-6);
}

TEST_F(Rawseeds, TheTruthOfTheRobotBecomesThatOfTheFrontalCamera) {
  const core::Trajectory truth = open()->truth().trajectory;
  ASSERT_EQ(truth.size(), 2U);
  EXPECT_TRUE(
      truth[0].world_from_camera.translation.isApprox(Eigen::Vector3d(0.829, 1.885, 1.068), 1e-9));
  const Eigen::Vector3d ahead = truth[1].world_from_camera.rotation * Eigen::Vector3d::UnitZ();
  EXPECT_TRUE(ahead.isApprox(Eigen::Vector3d::UnitY(), 1e-6)) << ahead.transpose();
}

TEST_F(Rawseeds, BrokenRowsOfTheTruthAreLeftOut) {
  folder_.write("Bicocca_2009-02-25b-GROUNDTRUTH.csv", "1,1,2\n2,1,2,nan\n3,1,2,0\n3,1,2,0\n");
  EXPECT_THAT(said_on_opening(), HasSubstr("3 of 4 poses of the ground truth are left out"));
  EXPECT_EQ(open()->truth().trajectory.size(), 1U);
}

TEST_F(Rawseeds, ImagesWithoutAStampAreLeftOutAndTwoOfOneAreRefused) {
  folder_.write_png("FRONTAL/FRONTAL_x.png", picture(32, 24));
  EXPECT_THAT(said_on_opening(), HasSubstr("1 of 4 images are left out"));
  folder_.write_png("FRONTAL/FRONTAL_1235604664.9064550.png", picture(32, 24));
  EXPECT_THAT(complaint_on_opening(), HasSubstr("has the stamp of another image"));
}

TEST_F(Rawseeds, AFolderWithoutImagesIsRefused) {
  std::filesystem::remove_all(folder_.at("FRONTAL"));
  std::filesystem::create_directories(folder_.at("FRONTAL"));
  EXPECT_THAT(complaint_on_opening(), HasSubstr("FRONTAL: holds no FRONTAL_<seconds>.png"));
}

}  // namespace
}  // namespace samewhere::input
