#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <samewhere/core/nanoseconds.hpp>
#include <samewhere/input/test_recording.hpp>

namespace samewhere::input {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr const char* kIdentityRows = "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n";

class SevenScenes : public Open {
 protected:
  SevenScenes() {
    for (const int number : {0, 1, 5}) {
      const std::string start = fmt::format("frame-{:06}", number);
      folder_.write_png(start + ".color.png", picture(32, 24, number));
      write_depth(start + ".depth.png");
      folder_.write(start + ".pose.txt",
                    fmt::format("0\t-1 0 {}\n1 0 0 0\n0 0 1.0e+000 2\n0 0 0 1\n", number));
    }
  }
};

TEST_F(SevenScenes, FramesDepthAndPosesComeTogether) {
  const auto source = open();
  EXPECT_EQ(source->info().format, "7-Scenes");
  EXPECT_EQ(source->info().num_frames, 3);
  const std::vector<core::Frame> frames = read_all();
  ASSERT_EQ(frames.size(), 3U);
  EXPECT_DOUBLE_EQ(frames[2].stamp_s, core::in_whole_nanoseconds(5.0 / 30.0));
  EXPECT_EQ(frames[2].name, "frame-000005.color.png");
  EXPECT_EQ(cv::norm(frames[2].images[0], picture(32, 24, 5), cv::NORM_INF), 0.0);
  EXPECT_FLOAT_EQ(frames[2].depth_m->at<float>(0, 0), 2.5F);
  const core::Trajectory truth = source->truth().trajectory;
  ASSERT_EQ(truth.size(), 3U);
  EXPECT_DOUBLE_EQ(truth[2].stamp_s, core::in_whole_nanoseconds(5.0 / 30.0));
  EXPECT_EQ(truth[2].world_from_camera.translation, Eigen::Vector3d(5.0, 0.0, 2.0));
  // a quarter turn about z: x of the camera is y of the world
  EXPECT_LT(
      (truth[2].world_from_camera.rotation * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitY())
          .norm(),
      1e-12);
}

TEST_F(SevenScenes, AMissingDepthImageIsNamedUnlessMostAre) {
  std::filesystem::remove(folder_.at("frame-000001.depth.png"));
  EXPECT_THAT(said_on_opening(),
              AllOf(HasSubstr("1 of 3 depth images"), HasSubstr("frame-000001.depth.png"),
                    HasSubstr("does not exist")));
  EXPECT_FALSE(read_all()[1].depth_m);
  EXPECT_TRUE(read_all()[2].depth_m);
  std::filesystem::remove(folder_.at("frame-000005.depth.png"));
  EXPECT_THAT(said_on_opening(), HasSubstr("refused: "));
}

TEST_F(SevenScenes, NoDepthAndNoPosesAtAllIsFine) {
  for (const int number : {0, 1, 5}) {
    std::filesystem::remove(folder_.at(fmt::format("frame-{:06}.depth.png", number)));
    std::filesystem::remove(folder_.at(fmt::format("frame-{:06}.pose.txt", number)));
  }
  const auto source = open();
  EXPECT_FALSE(source->info().has_depth);
  EXPECT_TRUE(source->truth().trajectory.empty());
}

TEST_F(SevenScenes, AMissingPoseFileIsLeftOut) {
  std::filesystem::remove(folder_.at("frame-000001.pose.txt"));
  EXPECT_THAT(said_on_opening(), HasSubstr("frame-000001.pose.txt"));
  EXPECT_EQ(open()->truth().trajectory.size(), 2U);
}

TEST_F(SevenScenes, ABrokenPoseFileIsLeftOutAndNamed) {
  folder_.write("frame-000001.pose.txt", "1 0 0 0\n0 1 0 nan\n0 0 1 0\n0 0 0 1\n");
  EXPECT_THAT(said_on_opening(),
              AllOf(HasSubstr("frame-000001.pose.txt, line 2"), HasSubstr("'nan'")));
  folder_.write("frame-000001.pose.txt", "1 0 0 0\n0 1 0\n0 0 1 0\n0 0 0 1\n");
  EXPECT_THAT(said_on_opening(), AllOf(HasSubstr("line 2"), HasSubstr("found 3 values")));
  folder_.write("frame-000001.pose.txt", "1 0 0 0\n0 1 0 0\n");
  EXPECT_THAT(said_on_opening(), HasSubstr("found 2 rows"));
  folder_.write("frame-000001.pose.txt", kIdentityRows);
  EXPECT_EQ(said_on_opening(), "");
}

TEST_F(SevenScenes, TwoImagesOfOneFrameAreNamed) {
  write_image("frame-000001.color.jpg");
  EXPECT_THAT(complaint_on_opening(),
              AllOf(HasSubstr("frame-000001.color.png"), HasSubstr("frame-000001.color.jpg")));
}

}  // namespace
}  // namespace samewhere::input
