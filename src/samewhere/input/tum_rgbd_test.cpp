#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <samewhere/input/test_recording.hpp>

namespace samewhere::input {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class TumRgbd : public Open {
 protected:
  TumRgbd() {
    for (const char* name : {"rgb/1.jpg", "rgb/2.jpg", "rgb/3.jpg"}) write_image(name);
    for (const char* name : {"depth/1.png", "depth/2.png"}) write_depth(name);
    folder_.write("rgb.txt",
                  "# color images\n# file: 'x.bag'\n100.000000 rgb/1.jpg\n100.033000 rgb/2.jpg\n"
                  "100.066000 rgb/3.jpg\n");
    folder_.write("depth.txt", "# depth maps\n100.001000 depth/1.png\n100.070000 depth/2.png\n");
    folder_.write("groundtruth.txt", "# truth\n99.9 1 2 3 0 0 0 1\n100.1 1 2 4 0 0 0 1\n");
    folder_.write("camera.txt", kCamera);
  }
};

TEST_F(TumRgbd, ColourDepthCameraAndTruthComeTogether) {
  const auto source = open();
  EXPECT_EQ(source->info().format, "TUM RGB-D");
  EXPECT_EQ(source->info().num_frames, 3);
  EXPECT_TRUE(source->info().has_depth);
  EXPECT_TRUE(source->info().is_calibrated);
  EXPECT_EQ(source->truth().trajectory.size(), 2U);
  const std::vector<core::Frame> frames = read_all();
  ASSERT_EQ(frames.size(), 3U);
  EXPECT_DOUBLE_EQ(frames[1].stamp_s, 100.033);
  EXPECT_EQ(frames[1].name, "rgb/2.jpg");
  ASSERT_TRUE(frames[0].depth_m);
  EXPECT_FLOAT_EQ(frames[0].depth_m->at<float>(5, 5), 0.5F);  // 2500 / 5000
  EXPECT_FALSE(frames[1].depth_m);                            // no depth image near in time
  EXPECT_TRUE(frames[2].depth_m);
}

TEST_F(TumRgbd, TheDepthFactorCanBeSet) {
  config_.depth_factor = 1000.0;
  EXPECT_FLOAT_EQ(read_all()[0].depth_m->at<float>(0, 0), 2.5F);
}

TEST_F(TumRgbd, TheCameraFileMaySayTheDepthFactorAndASettingOverrulesIt) {
  folder_.write("camera.txt", std::string(kCamera) + "depth_factor 250\n");
  EXPECT_FLOAT_EQ(read_all()[0].depth_m->at<float>(0, 0), 10.0F);
  config_.depth_factor = 1000.0;
  EXPECT_FLOAT_EQ(read_all()[0].depth_m->at<float>(0, 0), 2.5F);
}

TEST_F(TumRgbd, DepthCanBeLeftOut) {
  config_.depth = false;
  EXPECT_FALSE(open()->info().has_depth);
  for (const auto& frame : read_all()) EXPECT_FALSE(frame.depth_m);
}

TEST_F(TumRgbd, DepthThatFitsNoPictureIsRefusedWithTheWayOut) {
  const char* const way_out = "--set input.depth=false";
  folder_.write("depth.txt", "# depth maps\n200.001000 depth/1.png\n200.070000 depth/2.png\n");
  EXPECT_THAT(complaint_on_opening(),
              AllOf(HasSubstr("depth.txt: no depth image fits"), HasSubstr("99.935 s apart"),
                    HasSubstr("0.02 s (input.max_stamp_difference_s)"), HasSubstr(way_out)));
  folder_.write("depth.txt", "# depth maps\n1.5 depth/1.png\n100.0124 depth/2.png\n");
  config_.max_stamp_difference_s = 0.01;
  EXPECT_THAT(complaint_on_opening(), HasSubstr("0.0124 s apart"));
  folder_.write("depth.txt", "# depth maps\n");
  EXPECT_THAT(complaint_on_opening(),
              AllOf(HasSubstr("depth.txt: lists no depth image"), HasSubstr(way_out)));
  config_.depth = false;
  EXPECT_EQ(complaint_on_opening(), "no error");
  EXPECT_FALSE(open()->info().has_depth);
}

TEST_F(TumRgbd, DepthOfFewerThanHalfOfThePicturesIsWarnedOf) {
  const auto said = [&] {
    testing::internal::CaptureStdout();
    EXPECT_TRUE(open()->info().has_depth);
    return testing::internal::GetCapturedStdout();
  };
  EXPECT_EQ(said(), "");
  folder_.write("depth.txt", "100.001000 depth/1.png\n200.070000 depth/2.png\n");
  EXPECT_THAT(said(), AllOf(HasSubstr("depth.txt: only 1 of 3 pictures"), HasSubstr("0.02 s")));
}

TEST_F(TumRgbd, ColourAloneIsEnough) {
  for (const char* name : {"depth.txt", "camera.txt", "groundtruth.txt"}) {
    std::filesystem::remove(folder_.at(name));
  }
  const auto source = open();
  EXPECT_FALSE(source->info().has_depth);
  EXPECT_FALSE(source->info().is_calibrated);
  EXPECT_TRUE(source->truth().trajectory.empty());
  EXPECT_EQ(read_all().size(), 3U);
}

TEST_F(TumRgbd, AMissingImageIsLeftOutAndNamedUnlessMostAre) {
  std::filesystem::remove(folder_.at("depth/2.png"));
  EXPECT_THAT(said_on_opening(),
              AllOf(HasSubstr("1 of 2 depth images are left out"), HasSubstr("depth.txt, line 3"),
                    HasSubstr("depth/2.png does not exist")));
  EXPECT_FALSE(read_all()[2].depth_m);
  std::filesystem::remove(folder_.at("rgb/3.jpg"));
  EXPECT_THAT(said_on_opening(),
              AllOf(HasSubstr("1 of 3 colour images are left out"), HasSubstr("rgb.txt, line 5"),
                    HasSubstr("rgb/3.jpg does not exist")));
  EXPECT_EQ(read_all().size(), 2U);
  std::filesystem::remove(folder_.at("rgb/2.jpg"));
  EXPECT_THAT(said_on_opening(), AllOf(HasSubstr("refused: "), HasSubstr("rgb.txt, line 4"),
                                       HasSubstr("2 of 3 colour images")));
}

TEST_F(TumRgbd, ListsMayBeWrittenByOtherEditors) {
  const std::string list = "100 rgb/1.jpg\n100.033 rgb/2.jpg\n100.066 rgb/3.jpg\n";
  const auto with = [&list](const std::string& end) {
    std::string text;
    for (const char c : list) text += c == '\n' ? end : std::string(1, c);
    return text;
  };
  for (const std::string& text :
       {"\xef\xbb\xbf" + list, with("\r\n"), with("\r"), "\xef\xbb\xbf#\r\n" + with("\r\n"),
        std::string("timestamp filename\n100,rgb/1.jpg\n+100.033, rgb/2.jpg\n100.066\trgb/3.jpg\n"),
        std::string("100 rgb\\1.jpg\n100.033 \"rgb/2.jpg\"\n100.066 rgb/3.jpg extra\n")}) {
    folder_.write("rgb.txt", text);
    EXPECT_EQ(said_on_opening(), "") << text;
    EXPECT_EQ(read_all().size(), 3U) << text;
  }
}

TEST_F(TumRgbd, NamesMayHoldBlanks) {
  write_image("rgb images/my 1.jpg");
  for (const char* line : {"100 rgb images/my 1.jpg\n", "100 \"rgb images/my 1.jpg\"\n",
                           "100 'rgb images/my 1.jpg' floor\n", "100 rgb images/my 1.jpg 17\n"}) {
    folder_.write("rgb.txt", line);
    const std::vector<core::Frame> frames = read_all();
    ASSERT_EQ(frames.size(), 1U);
    EXPECT_EQ(frames[0].name, "rgb images/my 1.jpg") << line;
  }
  folder_.write("rgb.txt", "100 rgb images/gone 1.jpg\n");
  EXPECT_THAT(complaint_on_opening(), HasSubstr("image rgb images/gone 1.jpg does not exist"));
}

TEST_F(TumRgbd, PairsOfAListOfAssociationsAreTaken) {
  std::filesystem::remove(folder_.at("rgb.txt"));
  std::filesystem::remove(folder_.at("depth.txt"));
  for (const char* text :
       {"100 rgb/1.jpg 100.001 depth/1.png\n100.1 rgb/3.jpg 100.09 depth/2.png\n",
        "100 depth/1.png 100 rgb/1.jpg\n100.1 depth/2.png 100.1 rgb/3.jpg\n"}) {
    folder_.write("associations.txt", text);
    const std::vector<core::Frame> frames = read_all();
    ASSERT_EQ(frames.size(), 2U);
    EXPECT_EQ(frames[1].name, "rgb/3.jpg");
    EXPECT_DOUBLE_EQ(frames[1].stamp_s, 100.1);
    ASSERT_TRUE(frames[1].depth_m);
    EXPECT_FLOAT_EQ(frames[1].depth_m->at<float>(5, 5), 0.5F);
  }
  folder_.write("associations.txt", "100 rgb/1.jpg\n");
  EXPECT_THAT(complaint_on_opening(), HasSubstr("expected 'stamp filename stamp filename'"));
}

TEST_F(TumRgbd, StampsGoingBackwardsAreNamedWithLineAndBothStamps) {
  folder_.write("rgb.txt", "100.000000 rgb/1.jpg\n100.033000 rgb/2.jpg\n100.020000 rgb/3.jpg\n");
  EXPECT_THAT(complaint_on_opening(), AllOf(HasSubstr("rgb.txt, line 3"), HasSubstr("100.020000"),
                                            HasSubstr("100.033000")));
  folder_.write("rgb.txt", "100 rgb/1.jpg\n100 rgb/2.jpg\n");
  EXPECT_THAT(complaint_on_opening(), HasSubstr("stamp 100.000000 after 100.000000"));
}

TEST_F(TumRgbd, BrokenListsAreNamed) {
  folder_.write("rgb.txt", "100.0\n");
  EXPECT_THAT(complaint_on_opening(), AllOf(HasSubstr("rgb.txt, line 1"), HasSubstr("filename")));
  folder_.write("rgb.txt", "nan rgb/1.jpg\n");
  EXPECT_THAT(complaint_on_opening(), HasSubstr("'nan'"));
  folder_.write("rgb.txt", "# nothing\n");
  EXPECT_THAT(complaint_on_opening(), HasSubstr("lists no image"));
}

TEST_F(TumRgbd, RowsOfTheTruthThatCannotBeReadAreLeftOut) {
  const std::string good = "100 1 2 3 0 0 0 1\n101 1 2 4 0 0 0 1\n";
  for (const char* bad : {"99.9 1 2 nan 0 0 0 1\n", "100 1 2 9 0 0 0 1\n", "102 1 2 3\n",
                          "102 1 2 3 0 0 0 0\n", "lost at 17:03\n"}) {
    folder_.write("groundtruth.txt", good + bad);
    EXPECT_THAT(said_on_opening(), AllOf(HasSubstr("1 of 3 poses of the ground truth are left out"),
                                         HasSubstr("groundtruth.txt, line 3")))
        << bad;
    const core::Trajectory truth = open()->truth().trajectory;
    ASSERT_EQ(truth.size(), 2U) << bad;
    EXPECT_EQ(truth[0].world_from_camera.translation.z(), 3.0) << bad;
  }
}

TEST_F(TumRgbd, TruthMayHaveAHeaderCommasOrAnotherOrder) {
  for (const char* text : {"timestamp tx ty tz qx qy qz qw\n100 1 2 3 0 0 0 1\n101 1 2 4 0 0 0 1\n",
                           "100,1,2,3,0,0,0,1\n101, 1, 2, 4, 0, 0, 0, 1\n",
                           "101 1 2 4 0 0 0 1\n100 1 2 3 0 0 0 1\n"}) {
    folder_.write("groundtruth.txt", text);
    EXPECT_EQ(said_on_opening(), "") << text;
    const core::Trajectory truth = open()->truth().trajectory;
    ASSERT_EQ(truth.size(), 2U) << text;
    EXPECT_EQ(truth[0].world_from_camera.translation.z(), 3.0);
  }
}

TEST_F(TumRgbd, DepthOfAnotherSizeThanTheColourIsNamed) {
  write_depth("depth/2.png", 16);
  EXPECT_THAT(complaint_on_reading(), AllOf(HasSubstr("depth/2.png"), HasSubstr("16 x 24")));
}

}  // namespace
}  // namespace samewhere::input
