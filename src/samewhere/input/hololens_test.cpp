#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <samewhere/core/nanoseconds.hpp>
#include <samewhere/input/test_recording.hpp>

namespace samewhere::input {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class HoloLens : public Open {
 protected:
  HoloLens() {
    for (const char* number : {"00003", "00004", "00006"}) {
      write_image(fmt::format("images/{}.jpg", number));
      write_depth(fmt::format("depth/{}.png", number));
    }
    folder_.write("K.txt", kCamera);
    folder_.write("poses.txt", poses(3));
  }

  static std::string poses(int count) {
    std::string text;
    for (int i = 0; i < count; ++i) text += fmt::format("1 0 0 {} 0 1 0 0 0 0 1 0 0 0 0 1\n", i);
    return text;
  }
};

TEST_F(HoloLens, TheFileNumberIsTheFrameNumberAt12Hz) {
  const auto source = open();
  EXPECT_EQ(source->info().format, "HoloLens");
  EXPECT_TRUE(source->info().is_calibrated);
  const std::vector<core::Frame> frames = read_all();
  ASSERT_EQ(frames.size(), 3U);
  EXPECT_DOUBLE_EQ(frames[0].stamp_s, 0.25);
  EXPECT_DOUBLE_EQ(frames[2].stamp_s, 0.5);
  EXPECT_FLOAT_EQ(frames[2].depth_m->at<float>(0, 0), 2.5F);
  const core::Trajectory truth = source->truth().trajectory;
  ASSERT_EQ(truth.size(), 3U);
  EXPECT_DOUBLE_EQ(truth[2].stamp_s, 0.5);
  EXPECT_EQ(truth[2].world_from_camera.translation.x(), 2.0);
}

TEST_F(HoloLens, AMissingDepthImageIsNamed) {
  std::filesystem::remove(folder_.at("depth/00004.png"));
  EXPECT_THAT(said_on_opening(), AllOf(HasSubstr("1 of 3 depth images"), HasSubstr("00004.jpg")));
  EXPECT_FALSE(read_all()[1].depth_m);
  EXPECT_TRUE(read_all()[2].depth_m);
}

TEST_F(HoloLens, PosesTooManyOrTooFewAreWarnedOf) {
  folder_.write("poses.txt", poses(2));
  EXPECT_THAT(said_on_opening(), HasSubstr("found 2 poses, expected 3"));
  EXPECT_EQ(open()->truth().trajectory.size(), 2U);
  folder_.write("poses.txt", poses(4));
  EXPECT_THAT(said_on_opening(), HasSubstr("found 4 poses, expected 3"));
  EXPECT_EQ(open()->truth().trajectory.size(), 3U);
}

TEST_F(HoloLens, ABrokenPoseIsLeftOutAndNamedWithItsLine) {
  folder_.write("poses.txt", "1 0 0 inf 0 1 0 0 0 0 1 0 0 0 0 1\n" + poses(2));
  EXPECT_THAT(said_on_opening(), AllOf(HasSubstr("poses.txt, line 1"), HasSubstr("'inf'")));
  const core::Trajectory truth = open()->truth().trajectory;
  ASSERT_EQ(truth.size(), 2U);
  EXPECT_EQ(truth[0].stamp_s, core::in_whole_nanoseconds(4 / 12.0))
      << "the second line is that of the second frame";
  folder_.write("poses.txt", poses(2) + "1 0 0\n");
  EXPECT_THAT(said_on_opening(), HasSubstr("found 3 values, expected 16"));
}

TEST_F(HoloLens, AnImageWithoutNumberIsNamed) {
  write_image("images/door.jpg");
  EXPECT_THAT(complaint_on_opening(), AllOf(HasSubstr("door.jpg"), HasSubstr("no frame number")));
}

}  // namespace
}  // namespace samewhere::input
