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

  std::string complaint_on_reading(const std::string& name) {
    return complaint([&] {
      const auto source = open_source(folder_.at(name), config_);
      while (source->next()) {
      }
    });
  }

  // What the log says while the video is read.
  std::string said_on_reading(const std::string& name) {
    testing::internal::CaptureStdout();
    EXPECT_EQ(complaint_on_reading(name), "no error");
    return testing::internal::GetCapturedStdout();
  }

  // Sixty noisy pictures, 6 s.
  void write_long(const std::string& name, int writer_kind = cv::CAP_OPENCV_MJPEG,
                  int codec = cv::VideoWriter::fourcc('M', 'J', 'P', 'G')) const {
    cv::VideoWriter writer(folder_.at(name).string(), writer_kind, codec, 10.0, {64, 48});
    ASSERT_TRUE(writer.isOpened());
    cv::RNG random(1);
    cv::Mat noise(48, 64, CV_8UC3);
    for (int i = 0; i < 60; ++i) {
      random.fill(noise, cv::RNG::UNIFORM, 0, 255);
      writer.write(noise);
    }
  }

  // Four bytes, the lowest first.
  static void set_number(std::string& bytes, std::size_t at, int number) {
    for (std::size_t i = 0; i < 4; ++i) bytes.at(at + i) = static_cast<char>(number >> (8 * i));
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
  EXPECT_TRUE(source->info().is_video);
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
  EXPECT_THAT(complaint_about(folder_.at("walk.mp5")), HasSubstr("cannot be read as a video"));
}

TEST_F(Video, DamagedVideosNeverCrash) {
  const std::string whole = core::read_file(video());
  for (int percent = 0; percent < 100; percent += 7) {
    folder_.write("cut.avi",
                  whole.substr(0, whole.size() * static_cast<std::size_t>(percent) / 100));
    EXPECT_THAT(complaint_on_reading("cut.avi"), testing::AnyOf("no error", HasSubstr("cut.avi")))
        << percent;
  }
}

TEST_F(Video, OfOneThatIsCutShortIsUsedWhatIsThere) {
  write_long("long.avi");
  EXPECT_EQ(said_on_reading("long.avi"), "");
  for (const double kept_ratio : {0.9, 0.5, 0.2}) {
    write_long("long.avi");
    folder_.cut("long.avi", kept_ratio);
    EXPECT_THAT(said_on_reading("long.avi"),
                AllOf(HasSubstr("long.avi: ends after "), HasSubstr("expected 60 (6.0 s)")))
        << kept_ratio;
  }
  // whatever the stamps are said to be
  config_.fps = 1.0;
  EXPECT_THAT(said_on_reading("long.avi"), HasSubstr("expected 60 (6.0 s)"));
}

TEST_F(Video, OneWithAHoleIsWarnedOf) {
  write_long("long.avi");
  std::string bytes = core::read_file(folder_.at("long.avi"));
  std::fill_n(bytes.begin() + static_cast<std::ptrdiff_t>(bytes.size() / 2), bytes.size() / 4,
              '\0');
  folder_.write("long.avi", bytes);
  EXPECT_THAT(said_on_reading("long.avi"), HasSubstr("cut short or damaged"));
}

// Matroska has a length and no count: pictures may be missing because their rate varied.
TEST_F(Video, OneThatLastsAsLongAsItClaimsWithFewerPicturesIsWarnedOf) {
  write_long("long.mkv", cv::CAP_FFMPEG, cv::VideoWriter::fourcc('X', 'V', 'I', 'D'));
  std::string bytes = core::read_file(folder_.at("long.mkv"));
  std::fill_n(bytes.begin() + static_cast<std::ptrdiff_t>(bytes.size() / 2), bytes.size() / 4,
              '\0');
  folder_.write("hole.mkv", bytes);
  testing::internal::CaptureStdout();
  EXPECT_EQ(complaint_on_reading("long.mkv"), "no error");
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  testing::internal::CaptureStdout();
  EXPECT_EQ(complaint_on_reading("hole.mkv"), "no error");
  EXPECT_THAT(testing::internal::GetCapturedStdout(),
              AllOf(HasSubstr("hole.mkv: has "), HasSubstr(" of the 60 pictures it claims")));
  folder_.write("cut.mkv", bytes.substr(0, bytes.size() / 2));
  EXPECT_THAT(said_on_reading("cut.mkv"), HasSubstr("expected 60 (6.0 s)"));
}

TEST_F(Video, ACountThatIsTwoPicturesOffIsUsual) {
  for (const int num_claimed : {kNumFrames + 2, kNumFrames + 3, kNumFrames - 2, 0}) {
    std::string bytes = core::read_file(video());
    // the counts in the headers of an AVI: of the file 48 bytes in, of the stream behind "strh"
    set_number(bytes, 48, num_claimed);
    set_number(bytes, bytes.find("strh") + 8 + 32, num_claimed);
    folder_.write("off.avi", bytes);
    EXPECT_EQ(said_on_reading("off.avi").empty(), num_claimed != kNumFrames + 3) << num_claimed;
  }
}

TEST_F(Video, IsToldByItsContentToo) {
  std::filesystem::copy_file(video(), folder_.at("walk.bin"));
  EXPECT_EQ(open_source(folder_.at("walk.bin"), config_)->info().format, "video");
  EXPECT_TRUE(is_video(folder_.at("walk.bin")));
  folder_.write("list.bin", "1.png\n");
  EXPECT_FALSE(is_video(folder_.at("list.bin")));
  EXPECT_FALSE(is_video(folder_.root()));
}

TEST_F(Video, TheCameraFileBesideItIsUsedAndSaid) {
  const auto said = [this] {
    testing::internal::CaptureStdout();
    const bool is_calibrated = open_source(video(), config_)->info().is_calibrated;
    return std::string(is_calibrated ? "used: " : "not used: ") +
           testing::internal::GetCapturedStdout();
  };
  EXPECT_EQ(said(), "not used: ");
  folder_.write("camera.txt", "60 0 31.5\n0 60 23.5\n0 0 1\n");
  EXPECT_THAT(said(), AllOf(HasSubstr("used: "), HasSubstr("camera.txt: taken for the camera of")));
  folder_.write("camera.txt", "60 0 315\n0 60 23.5\n0 0 1\n");
  EXPECT_THAT(said(), AllOf(HasSubstr("not used: "), HasSubstr("wrong calibration")));
  for (const char* name : {"walk.camera.txt", "walk.avi.camera.txt"}) {
    folder_.write(name, "61 0 31.5\n0 60 23.5\n0 0 1\n");
    EXPECT_THAT(said(), AllOf(HasSubstr("used: "), HasSubstr(name))) << name;
  }
}

// The matrix of a track in an MP4 file turns it: here by 90 degrees.
TEST_F(Video, ARotationIsSaidAndNotApplied) {
  write_long("turned.mp4", cv::CAP_FFMPEG, cv::VideoWriter::fourcc('m', 'p', '4', 'v'));
  EXPECT_EQ(said_on_reading("turned.mp4"), "");
  std::string bytes = core::read_file(folder_.at("turned.mp4"));
  const std::size_t matrix = bytes.find("tkhd") + 4 + 40;
  const std::string quarter_turn("\0\0\0\0\0\1\0\0\0\0\0\0\xff\xff\0\0\0\0\0\0", 20);
  bytes.replace(matrix, quarter_turn.size(), quarter_turn);
  folder_.write("turned.mp4", bytes);
  EXPECT_THAT(said_on_reading("turned.mp4"),
              AllOf(HasSubstr("turned.mp4"), HasSubstr("turns it by 90 degrees")));
  EXPECT_EQ(open_source(folder_.at("turned.mp4"), config_)->next()->images[0].size(),
            cv::Size(64, 48));
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
