#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <samewhere/input/open.hpp>
#include <samewhere/input/test_folder.hpp>

namespace samewhere::input {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr const char* kCamera = "30 0 15.5\n0 30 11.5\n0 0 1\n";
constexpr const char* kIdentityRows = "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n";

class Open : public testing::Test {
 protected:
  std::unique_ptr<core::Source> open() { return open_source(folder_.root(), config_); }

  std::vector<core::Frame> read_all() {
    const auto source = open();
    std::vector<core::Frame> frames;
    while (std::optional<core::Frame> frame = source->next()) frames.push_back(*frame);
    return frames;
  }

  std::string complaint_on_opening() {
    return complaint([this] { open(); });
  }
  std::string complaint_on_reading() {
    const auto source = open();
    return complaint([&] {
      while (source->next()) {
      }
    });
  }

  void write_image(const std::string& name, int width_px = 32) const {
    folder_.write_jpeg(name, picture(width_px, 24));
  }
  void write_depth(const std::string& name, int width_px = 32) const {
    folder_.write_png(name, cv::Mat(24, width_px, CV_16UC1, cv::Scalar(2500)));
  }

  TestFolder folder_;
  Config config_;
};

// ---- anything

TEST_F(Open, AMissingFolderIsNamed) {
  EXPECT_THAT(complaint([&] { open_source(folder_.root() / "gone", config_); }),
              AllOf(HasSubstr("gone"), HasSubstr("does not exist")));
}

TEST_F(Open, APathTooLongForTheSystemIsAnErrorNotACrash) {
  EXPECT_THAT(complaint([&] { open_source(std::string(5000, 'x'), config_); }),
              HasSubstr("does not exist"));
}

TEST_F(Open, AnEmptyFolderIsNamed) {
  EXPECT_THAT(complaint_on_opening(),
              AllOf(HasSubstr(folder_.root().string()), HasSubstr("the folder is empty")));
}

TEST_F(Open, AnUnknownLayoutSaysWhatWasLookedFor) {
  folder_.write("notes.md", "hello");
  EXPECT_THAT(complaint_on_opening(), AllOf(HasSubstr("rgb.txt"), HasSubstr("frame-*.color.png"),
                                            HasSubstr("K.txt"), HasSubstr("*.jpg")));
}

TEST_F(Open, ASceneOfSeveralSequencesAsksForOne) {
  folder_.write("seq-01/frame-000000.color.png", "");
  folder_.write("TestSplit.txt", "sequence1");
  EXPECT_THAT(complaint_on_opening(), AllOf(HasSubstr("several sequences"), HasSubstr("/seq-01")));
}

TEST_F(Open, SlipsInTheSettingsAreNamed) {
  write_image("1.jpg");
  config_.fps = 1e-300;
  EXPECT_THAT(complaint_on_opening(), HasSubstr("input.fps = 1e-300"));
  config_ = {};
  config_.depth_factor = 0.001;
  EXPECT_THAT(complaint_on_opening(), HasSubstr("input.depth_factor = 0.001"));
}

TEST_F(Open, ACameraFileOfTheUserReplacesTheFoldersOwn) {
  write_image("1.jpg");
  folder_.write("camera.txt", "broken");
  folder_.write("mine/camera.txt", kCamera);
  config_.camera = folder_.at("mine/camera.txt").string();
  const auto source = open();
  EXPECT_TRUE(source->info().is_calibrated);
  const auto frame = source->next();
  ASSERT_TRUE(frame);
  const auto& camera = std::get<core::PinholeRadtan>(frame->rig->cameras.at(0));
  EXPECT_EQ(camera.width_px, 32);
  EXPECT_EQ(camera.height_px, 24);
  EXPECT_EQ(camera.cx_px, 15.5);
  EXPECT_EQ(frame->rig->body_from_camera.size(), 1U);
  config_.camera = folder_.at("gone.txt").string();
  EXPECT_THAT(complaint_on_opening(), HasSubstr("gone.txt"));
}

TEST_F(Open, ACentreOutsideTheImageIsAWrongCalibration) {
  write_image("1.jpg");
  folder_.write("camera.txt", "500 0 320\n0 500 11\n0 0 1\n");
  EXPECT_THAT(complaint_on_opening(), AllOf(HasSubstr("camera.txt"), HasSubstr("wrong calibration"),
                                            HasSubstr("(320, 11)"), HasSubstr("32 x 24")));
}

// ---- image folder

TEST_F(Open, AnImageFolderIsReadInTheOrderOfItsNumbers) {
  for (const char* name : {"10.jpg", "2.jpg", "1.jpg"}) write_image(name);
  folder_.write("readme.txt", "not an image");
  const auto source = open();
  EXPECT_EQ(source->info().format, "images");
  EXPECT_EQ(source->info().name, folder_.root().filename().string());
  EXPECT_EQ(source->info().num_frames, 3);
  EXPECT_FALSE(source->info().is_calibrated);
  EXPECT_FALSE(source->info().has_depth);
  const std::vector<core::Frame> frames = read_all();
  ASSERT_EQ(frames.size(), 3U);
  EXPECT_EQ(frames[2].name, "10.jpg");
  EXPECT_EQ(frames[2].id, core::FrameId(2));
  EXPECT_DOUBLE_EQ(frames[1].stamp_s, 2.0 / 30.0);
  EXPECT_DOUBLE_EQ(frames[2].stamp_s, 10.0 / 30.0);
  EXPECT_FALSE(frames[0].depth_m);
  ASSERT_TRUE(frames[0].rig);
  EXPECT_FALSE(frames[0].rig->is_calibrated());
}

TEST_F(Open, NamesWithoutNumbersCountByPosition) {
  for (const char* name : {"door.jpg", "hall.png", "lamp7.jpg"}) write_image(name);
  config_.fps = 10.0;
  const std::vector<core::Frame> frames = read_all();
  ASSERT_EQ(frames.size(), 3U);
  EXPECT_DOUBLE_EQ(frames[0].stamp_s, 0.0);
  EXPECT_DOUBLE_EQ(frames[2].stamp_s, 0.2);
}

TEST_F(Open, NumbersThatStartAgainCountByPosition) {
  for (const char* name : {"a_1.jpg", "a_2.jpg", "b_1.jpg"}) write_image(name);
  const std::vector<core::Frame> frames = read_all();
  ASSERT_EQ(frames.size(), 3U);
  EXPECT_DOUBLE_EQ(frames[2].stamp_s, 2.0 / 30.0);
}

TEST_F(Open, AnImageOfAnotherSizeInTheMiddleIsNamed) {
  write_image("1.jpg");
  write_image("2.jpg", 40);
  write_image("3.jpg");
  EXPECT_THAT(complaint_on_reading(),
              AllOf(HasSubstr("2.jpg"), HasSubstr("40 x 24"), HasSubstr("expected 32 x 24")));
}

TEST_F(Open, AnImageCutInHalfIsNamed) {
  write_image("1.jpg");
  write_image("2.jpg");
  folder_.cut("2.jpg", 0.5);
  EXPECT_THAT(complaint_on_reading(), HasSubstr("2.jpg"));
  folder_.cut("1.jpg", 0.5);
  EXPECT_THAT(complaint_on_opening(), HasSubstr("1.jpg"));
}

TEST_F(Open, TruthBesideTheImagesIsRead) {
  for (const char* name : {"1.jpg", "2.jpg"}) write_image(name);
  folder_.write("groundtruth.tum", "0.5 1 2 3 0 0 0 1\n");
  folder_.write("same_place.txt", "0 0\n1 0\n");
  const core::Truth truth = open()->truth();
  ASSERT_EQ(truth.trajectory.size(), 1U);
  EXPECT_EQ(truth.trajectory[0].world_from_camera.translation.z(), 3.0);
  ASSERT_TRUE(truth.places);
  EXPECT_EQ(truth.places->at(1, 0), core::PlaceTruth::kSame);
  write_image("3.jpg");
  EXPECT_THAT(complaint_on_opening(), HasSubstr("2 rows, expected 3"));
}

// ---- list of images

TEST_F(Open, AListIsReadInItsOwnOrderAndMayNameAnImageTwice) {
  write_image("b/2.jpg");
  write_image("a/1.jpg");
  folder_.write("walk.txt", "# image floor\nb/2.jpg floor3 17\r\na/1.jpg\n\nb/2.jpg\n");
  config_.fps = 2.0;
  const auto source = open_source(folder_.at("walk.txt"), config_);
  EXPECT_EQ(source->info().name, "walk");
  EXPECT_EQ(source->info().format, "image list");
  EXPECT_EQ(source->info().num_frames, 3);
  EXPECT_EQ(source->next()->name, "b/2.jpg");
  EXPECT_EQ(source->next()->name, "a/1.jpg");
  EXPECT_DOUBLE_EQ(source->next()->stamp_s, 1.0);
  EXPECT_FALSE(source->next());
}

TEST_F(Open, AMissingImageOfAListIsNamedWithItsLine) {
  write_image("1.jpg");
  folder_.write("walk.txt", "# list\n1.jpg\n2.jpg\n");
  EXPECT_THAT(complaint([&] { open_source(folder_.at("walk.txt"), config_); }),
              AllOf(HasSubstr("walk.txt, line 3"), HasSubstr("2.jpg does not exist")));
}

TEST_F(Open, AFileThatIsNoListIsNamed) {
  folder_.write("empty.txt", "# nothing\n");
  EXPECT_THAT(complaint([&] { open_source(folder_.at("empty.txt"), config_); }),
              HasSubstr("lists no image"));
  write_image("1.jpg");
  EXPECT_THAT(complaint([&] { open_source(folder_.at("1.jpg"), config_); }),
              AllOf(HasSubstr("1.jpg"), HasSubstr("binary file")));
}

// ---- TUM RGB-D

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

TEST_F(TumRgbd, AMissingDepthImageIsNamed) {
  std::filesystem::remove(folder_.at("depth/2.png"));
  EXPECT_THAT(complaint_on_opening(),
              AllOf(HasSubstr("depth.txt, line 3"), HasSubstr("depth/2.png does not exist")));
}

TEST_F(TumRgbd, AMissingColourImageIsNamed) {
  std::filesystem::remove(folder_.at("rgb/3.jpg"));
  EXPECT_THAT(complaint_on_opening(),
              AllOf(HasSubstr("rgb.txt, line 5"), HasSubstr("rgb/3.jpg does not exist")));
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

TEST_F(TumRgbd, BrokenTruthIsNamedOnOpening) {
  folder_.write("groundtruth.txt", "# truth\n99.9 1 2 nan 0 0 0 1\n");
  EXPECT_THAT(complaint_on_opening(), HasSubstr("groundtruth.txt, line 2"));
}

TEST_F(TumRgbd, DepthOfAnotherSizeThanTheColourIsNamed) {
  write_depth("depth/2.png", 16);
  EXPECT_THAT(complaint_on_reading(), AllOf(HasSubstr("depth/2.png"), HasSubstr("16 x 24")));
}

// ---- 7-Scenes

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
  EXPECT_DOUBLE_EQ(frames[2].stamp_s, 5.0 / 30.0);
  EXPECT_EQ(frames[2].name, "frame-000005.color.png");
  EXPECT_EQ(cv::norm(frames[2].images[0], picture(32, 24, 5), cv::NORM_INF), 0.0);
  EXPECT_FLOAT_EQ(frames[2].depth_m->at<float>(0, 0), 2.5F);
  const core::Trajectory truth = source->truth().trajectory;
  ASSERT_EQ(truth.size(), 3U);
  EXPECT_DOUBLE_EQ(truth[2].stamp_s, 5.0 / 30.0);
  EXPECT_EQ(truth[2].world_from_camera.translation, Eigen::Vector3d(5.0, 0.0, 2.0));
  // a quarter turn about z: x of the camera is y of the world
  EXPECT_LT(
      (truth[2].world_from_camera.rotation * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitY())
          .norm(),
      1e-12);
}

TEST_F(SevenScenes, AMissingDepthImageIsNamed) {
  std::filesystem::remove(folder_.at("frame-000001.depth.png"));
  EXPECT_THAT(complaint_on_opening(),
              AllOf(HasSubstr("frame-000001.depth.png"), HasSubstr("does not exist")));
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

TEST_F(SevenScenes, AMissingPoseFileIsNamed) {
  std::filesystem::remove(folder_.at("frame-000001.pose.txt"));
  EXPECT_THAT(complaint_on_opening(), HasSubstr("frame-000001.pose.txt"));
}

TEST_F(SevenScenes, ABrokenPoseFileIsNamed) {
  folder_.write("frame-000001.pose.txt", "1 0 0 0\n0 1 0 nan\n0 0 1 0\n0 0 0 1\n");
  EXPECT_THAT(complaint_on_opening(),
              AllOf(HasSubstr("frame-000001.pose.txt, line 2"), HasSubstr("'nan'")));
  folder_.write("frame-000001.pose.txt", "1 0 0 0\n0 1 0\n0 0 1 0\n0 0 0 1\n");
  EXPECT_THAT(complaint_on_opening(), AllOf(HasSubstr("line 2"), HasSubstr("found 3 values")));
  folder_.write("frame-000001.pose.txt", "1 0 0 0\n0 1 0 0\n");
  EXPECT_THAT(complaint_on_opening(), HasSubstr("found 2 rows"));
  folder_.write("frame-000001.pose.txt", kIdentityRows);
  EXPECT_EQ(complaint_on_opening(), "no error");
}

TEST_F(SevenScenes, TwoImagesOfOneFrameAreNamed) {
  write_image("frame-000001.color.jpg");
  EXPECT_THAT(complaint_on_opening(),
              AllOf(HasSubstr("frame-000001.color.png"), HasSubstr("frame-000001.color.jpg")));
}

// ---- HoloLens

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
  EXPECT_THAT(complaint_on_opening(), HasSubstr("depth/00004.png"));
}

TEST_F(HoloLens, OnePoseTooManyOrTooFewIsAnError) {
  folder_.write("poses.txt", poses(2));
  EXPECT_THAT(complaint_on_opening(), HasSubstr("found 2 poses, expected 3"));
  folder_.write("poses.txt", poses(4));
  EXPECT_THAT(complaint_on_opening(), HasSubstr("found 4 poses, expected 3"));
}

TEST_F(HoloLens, ABrokenPoseIsNamedWithItsLine) {
  folder_.write("poses.txt", poses(2) + "1 0 0 inf 0 1 0 0 0 0 1 0 0 0 0 1\n");
  EXPECT_THAT(complaint_on_opening(), AllOf(HasSubstr("poses.txt, line 3"), HasSubstr("'inf'")));
  folder_.write("poses.txt", poses(2) + "1 0 0\n");
  EXPECT_THAT(complaint_on_opening(), HasSubstr("found 3 values, expected 16"));
}

TEST_F(HoloLens, AnImageWithoutNumberIsNamed) {
  write_image("images/door.jpg");
  EXPECT_THAT(complaint_on_opening(), AllOf(HasSubstr("door.jpg"), HasSubstr("no frame number")));
}

}  // namespace
}  // namespace samewhere::input
