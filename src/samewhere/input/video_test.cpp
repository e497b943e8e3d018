#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/videoio.hpp>

#include <samewhere/input/test_recording.hpp>
#include <samewhere/input/video.hpp>

namespace samewhere::input {
namespace {

using testing::AllOf;
using testing::HasSubstr;

// A video of five grey pictures, each brighter than the one before, at 10 frames a second.
class Video : public testing::Test {
 protected:
  Video() {
    cv::VideoWriter writer(video().string(), cv::CAP_OPENCV_MJPEG,
                           cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), 10.0, {64, 48});
    EXPECT_TRUE(writer.isOpened());
    for (int i = 0; i < kNumFrames; ++i) {
      writer.write(cv::Mat(48, 64, CV_8UC3, cv::Scalar::all(grey(i))));
    }
  }

  static int grey(int i) { return 20 + 40 * i; }
  std::filesystem::path video() const { return folder_.at("walk.avi"); }
  std::string complaint_about(const std::filesystem::path& path) {
    return complaint([&] { open_source(path, config_); });
  }

  static constexpr int kNumFrames = 5;
  TestFolder folder_;
  Config config_;
};

TEST_F(Video, PicturesComeInOrderWithTheStampsOfTheFile) {
  const auto source = open_source(video(), config_);
  EXPECT_EQ(source->info().name, "walk");
  EXPECT_EQ(source->info().format, "video");
  EXPECT_EQ(source->info().num_frames, kNumFrames);
  EXPECT_FALSE(source->info().is_calibrated);
  EXPECT_FALSE(source->info().is_live);
  EXPECT_NEAR(source->info().frame_rate_hz, 10.0, 1e-9);
  std::vector<core::Frame> frames;
  while (auto frame = source->next()) frames.push_back(*std::move(frame));
  ASSERT_EQ(frames.size(), std::size_t{kNumFrames});
  for (int i = 0; i < kNumFrames; ++i) {
    const core::Frame& frame = frames[static_cast<std::size_t>(i)];
    EXPECT_EQ(frame.id.index(), static_cast<std::uint64_t>(i));
    EXPECT_NEAR(frame.stamp_s - frames[0].stamp_s, 0.1 * i, 1e-6);
    EXPECT_EQ(frame.name, fmt::format("walk.avi picture {}", i));
    EXPECT_EQ(frame.images.at(0).type(), CV_8UC3);
    // kept, they do not change when the next is read
    EXPECT_NEAR(frame.images[0].at<cv::Vec3b>(20, 20)[1], grey(i), 3);
    EXPECT_FALSE(frame.depth_m);
  }
  EXPECT_FALSE(source->next());
}

TEST_F(Video, ItsCameraFileAndFrameRateMayBeGiven) {
  folder_.write("camera.txt", "60 0 31.5\n0 60 23.5\n0 0 1\n");
  config_.camera = folder_.at("camera.txt").string();
  config_.fps = 4.0;
  const auto source = open_source(video(), config_);
  EXPECT_TRUE(source->info().is_calibrated);
  EXPECT_EQ(source->info().frame_rate_hz, 4.0);
  source->next();
  const core::Frame second = source->next().value();
  EXPECT_EQ(second.stamp_s, 0.25);
  EXPECT_EQ(std::get<core::PinholeRadtan>(second.rig->cameras.at(0)).width_px, 64);
  folder_.write("camera.txt", "60 0 315\n0 60 23.5\n0 0 1\n");
  EXPECT_THAT(complaint_about(video()),
              AllOf(HasSubstr("camera.txt: wrong calibration"), HasSubstr("64 x 48")));
}

TEST_F(Video, WhatIsNoVideoIsNamed) {
  folder_.write("notes.mp4", "to whom it may concern");
  EXPECT_THAT(complaint_about(folder_.at("notes.mp4")),
              AllOf(HasSubstr("notes.mp4"), HasSubstr("cannot be read as a video")));
  folder_.write("empty.avi", "");
  EXPECT_THAT(complaint_about(folder_.at("empty.avi")), HasSubstr("cannot be read as a video"));
  EXPECT_THAT(complaint_about(folder_.at("gone.mp4")), HasSubstr("gone.mp4: does not exist"));
  folder_.write("walk.mp5", std::string("\0\1\2", 3));
  EXPECT_THAT(complaint_about(folder_.at("walk.mp5")), HasSubstr("a video (.mp4"));
}

TEST_F(Video, DamagedVideosNeverCrash) {
  const std::string whole = core::read_file(video());
  for (int percent = 0; percent < 100; percent += 7) {
    folder_.write("cut.avi",
                  whole.substr(0, whole.size() * static_cast<std::size_t>(percent) / 100));
    const std::string said = complaint([&] {
      const auto source = open_source(folder_.at("cut.avi"), config_);
      while (source->next()) {
      }
    });
    EXPECT_THAT(said, testing::AnyOf("no error", HasSubstr("cut.avi"))) << percent;
  }
}

TEST_F(Video, AMissingCameraOrOneThatIsNoneIsNamed) {
  EXPECT_THAT(complaint_about("/dev/video977"),
              AllOf(HasSubstr("/dev/video977: does not exist"), HasSubstr("a camera")));
  EXPECT_THAT(complaint_about("/dev/null"),
              AllOf(HasSubstr("/dev/null"), HasSubstr("cannot be opened as a camera")));
}

TEST_F(Video, AMissingPluginIsNamed) {
  const std::filesystem::path gone = folder_.at("samewhere-video.so");
  EXPECT_THAT(complaint([&] { open_video(video(), config_, gone); }),
              AllOf(HasSubstr("samewhere-video.so"), HasSubstr("cannot be loaded"),
                    HasSubstr("./run build")));
  folder_.write("samewhere-video.so", "no library");
  EXPECT_THAT(complaint([&] { open_video(video(), config_, gone); }),
              HasSubstr("cannot be loaded"));
}

TEST(VideoName, IsToldByItsEndInAnyLetters) {
  for (const char* name : {"a.mp4", "b/c.MOV", "d.e.avi", "f.mkv"}) {
    EXPECT_TRUE(is_video_name(name)) << name;
  }
  for (const char* name : {"a.txt", "mp4", "video", "a.mp4.txt"}) {
    EXPECT_FALSE(is_video_name(name)) << name;
  }
}

}  // namespace
}  // namespace samewhere::input
