// Checkerboards, videos and cameras on the command line.

#include <algorithm>
#include <chrono>
#include <sstream>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "program.hpp"
#include <samewhere/geometry/camera.hpp>
#include <samewhere/geometry/test_board.hpp>
#include <samewhere/input/camera_file.hpp>
#include <samewhere/input/test_folder.hpp>

namespace samewhere::test {
namespace {

using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;

class InputCommands : public testing::Test {
 protected:
  Outcome run(const std::string& arguments) const { return run_program(arguments, folder_.root()); }
  std::filesystem::path path(const std::string& name) const { return folder_.root() / name; }

  static cv::Mat rendered_board(const Eigen::Vector3d& turn_rad, const Eigen::Vector3d& middle_m) {
    constexpr core::PinholeRadtan kCamera{.width_px = 320,
                                          .height_px = 240,
                                          .fx_px = 260.0,
                                          .fy_px = 260.0,
                                          .cx_px = 161.0,
                                          .cy_px = 118.0,
                                          .k1 = -0.1};
    const core::Rigid3 middle_from_board{Eigen::Quaterniond::Identity(), {-0.06, -0.045, 0.0}};
    const core::Rigid3 camera_from_middle{core::exp_so3(turn_rad), middle_m};
    return geometry::render_board(kCamera, camera_from_middle * middle_from_board, {5, 4, 0.03});
  }
  void write_board(const std::string& name, const Eigen::Vector3d& turn_rad) const {
    folder_.write_png(name, rendered_board(turn_rad, {0.0, 0.0, 0.24}));
  }

  // Four pictures in 0.4 s.
  void write_video(const std::string& name) const {
    cv::VideoWriter writer(path(name).string(), cv::CAP_OPENCV_MJPEG,
                           cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), 10.0, {64, 48});
    for (int i = 0; i < 4; ++i) writer.write(cv::Mat(48, 64, CV_8UC3, cv::Scalar::all(60 * i)));
  }

  static void expect_one_line(const Outcome& outcome, const std::string& words) {
    EXPECT_EQ(outcome.exit_code, 2) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr(words));
    // but for progress, which a slow machine prints
    std::istringstream lines(outcome.err);
    int num_lines = 0;
    for (std::string line; std::getline(lines, line);)
      num_lines += line.find(" per s  ") == std::string::npos ? 1 : 0;
    EXPECT_EQ(num_lines, 1) << outcome.err;
  }

  input::TestFolder folder_;
};

TEST_F(InputCommands, CalibrateTakesSharpFramesOfAVideoThatLieApart) {
  cv::VideoWriter writer(path("board.avi").string(), cv::CAP_OPENCV_MJPEG,
                         cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), 4.0, {320, 240});
  for (const Eigen::Vector3d& turn_rad :
       {Eigen::Vector3d(0.0, 0.0, 0.0), Eigen::Vector3d(0.4, 0.0, 0.0),
        Eigen::Vector3d(-0.4, 0.1, 0.0), Eigen::Vector3d(0.0, 0.4, 0.1),
        Eigen::Vector3d(0.1, -0.45, 0.0), Eigen::Vector3d(0.3, 0.3, 0.3)}) {
    cv::Mat image;
    cv::cvtColor(rendered_board(turn_rad, {0.1 * turn_rad.y(), 0.05 * turn_rad.x(), 0.24}), image,
                 cv::COLOR_GRAY2BGR);
    for (int i = 0; i < 4; ++i) writer.write(image);  // a second, two stretches
  }
  writer.release();
  const Outcome outcome = run("calibrate " + quoted(path("board.avi")) +
                              " --board 5x4 --square 0.03 --out " + quoted(path("video.txt")));
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("12 with the board, 6 distinct views used"));
  const auto camera = geometry::pinhole(input::read_camera_file(path("video.txt")).camera);
  EXPECT_NEAR(camera.fx_px, 260.0, 6.0);
}

TEST_F(InputCommands, CalibrateWritesTheCameraThatRunReads) {
  const std::string rest = " --board 5x4 --square 0.03 --out " + quoted(path("camera.txt"));
  const std::string calibrate = "calibrate " + quoted(path("boards")) + rest;
  write_board("boards/1.png", {0.5, 0.0, 0.1});
  write_board("boards/2.png", {-0.5, 0.1, 0.0});
  folder_.write_png("boards/3.png", cv::Mat(240, 320, CV_8UC1, cv::Scalar(90)));
  expect_one_line(run(calibrate), "5 x 4 inner corners in 2 pictures");
  EXPECT_FALSE(std::filesystem::exists(path("camera.txt")));
  write_board("boards/4.png", {0.1, 0.6, 0.0});
  write_board("boards/5.png", {0.0, -0.6, 0.1});
  const Outcome outcome = run(calibrate);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("no board in 1 of 5 pictures: 3.png"));
  EXPECT_THAT(outcome.out, HasSubstr("4.png"));
  const auto camera = geometry::pinhole(input::read_camera_file(path("camera.txt")).camera);
  EXPECT_NEAR(camera.fx_px, 260.0, 2.6);
  EXPECT_NEAR(camera.cx_px, 161.0, 2.0);
  EXPECT_EQ(camera.width_px, 320);
  EXPECT_EQ(camera.height_px, 240);
  expect_one_line(
      run("calibrate " + quoted(path("boards")) + " --board 5by4 --square 0.03 --out x"),
      "--board 5by4: expected COLUMNSxROWS");
}

// In noisy pictures they look tilted: fx 3455 px instead of 260 fits them best.
TEST_F(InputCommands, CalibrateRefusesBoardsThatAllFaceTheCamera) {
  for (int i = 0; i < 12; ++i) {
    const Eigen::Vector3d middle_m(0.005 * (i % 4) - 0.007, 0.004 * (i % 3) - 0.004,
                                   0.24 + 0.01 * i);
    cv::Mat image = rendered_board({0.0, 0.0, 0.05 * i - 0.3}, middle_m);
    cv::Mat noise(image.size(), CV_16S);
    cv::RNG(static_cast<std::uint64_t>(i + 1)).fill(noise, cv::RNG::NORMAL, 0.0, 45.0);
    cv::add(image, noise, image, cv::noArray(), CV_8U);
    folder_.write_png(fmt::format("boards/{}.png", i), image);
  }
  expect_one_line(run("calibrate " + quoted(path("boards")) + " --board 5x4 --square 0.03 --out " +
                      quoted(path("camera.txt"))),
                  "expected to 3 % or better");
  EXPECT_FALSE(std::filesystem::exists(path("camera.txt")));
}

TEST_F(InputCommands, LoopsLooksThroughAVideo) {
  write_video("walk.avi");
  const std::string rest = " --set retrieve.window_frames=0 --out " + quoted(path("out"));
  const Outcome outcome = run("loops " + quoted(path("walk.avi")) + rest);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_TRUE(std::filesystem::exists(path("out/matches.txt")));
  EXPECT_THAT(outcome.out, Not(HasSubstr("frames dropped")));
}

TEST_F(InputCommands, LoopsPlaysAVideoAndTellsWhatWasDropped) {
  write_video("walk.avi");
  const Outcome outcome =
      run("loops " + quoted(path("walk.avi")) + " --realtime --out " + quoted(path("out")));
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, ContainsRegex("frames dropped  *[0-3]\n"));
  EXPECT_TRUE(std::filesystem::exists(path("out/matches.txt")));
  EXPECT_THAT(core::read_file(path("out/config.yaml")), HasSubstr("realtime: true"));
}

TEST_F(InputCommands, CtrlCDoesNotWaitForTheNextPictureThatIsPlayed) {
  write_video("walk.avi");
  const auto start = std::chrono::steady_clock::now();
  const Outcome cut =
      interrupt_program("loops " + quoted(path("walk.avi")) +
                            " --realtime --set input.fps=0.005 --out " + quoted(path("out")),
                        "[ -e " + quoted(path("out/config.yaml")) + " ]", folder_.root());
  EXPECT_EQ(cut.exit_code, 130) << cut.err;
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(100))
      << "the next is due after 200 s";
  EXPECT_TRUE(std::filesystem::exists(path("out/report.html")));
}

TEST_F(InputCommands, WhatIsNoVideoAndNoCameraIsNotPlayed) {
  folder_.write_png("pictures/1.png", cv::Mat(48, 64, CV_8UC1, cv::Scalar(90)));
  const std::string rest = " --realtime --out " + quoted(path("out"));
  for (const std::string& source : {quoted(path("pictures")), std::string("twin:office-loop")})
    expect_one_line(run("loops " + source + rest), "is neither a video nor a camera");
  EXPECT_FALSE(std::filesystem::exists(path("out")));
}

TEST_F(InputCommands, WhatIsNoVideoOrNoCameraIsOneLine) {
  folder_.write("walk.mp4", "no video");
  expect_one_line(run("loops " + quoted(path("walk.mp4"))), "walk.mp4: cannot be read as a video");
  expect_one_line(run("run /dev/video977 --realtime"), "/dev/video977: does not exist");
  expect_one_line(run("run /dev/null --realtime"), "/dev/null: cannot be opened as a camera");
}

TEST_F(InputCommands, AVideoWithoutThePluginIsOneLine) {
  folder_.write("walk.mp4", "no video");
  std::filesystem::copy_file(SAMEWHERE_PROGRAM, path("samewhere"));
  const std::string lonely = "'" + path("samewhere").string() + "' loops " +
                             quoted(path("walk.mp4")) + " 2>" + quoted(path("err.txt"));
  const int status = std::system(lonely.c_str());
  expect_one_line({WEXITSTATUS(status), "", core::read_file(path("err.txt"))},
                  "samewhere-video.so: the plugin that reads videos, cameras, BMP");
}

}  // namespace
}  // namespace samewhere::test
