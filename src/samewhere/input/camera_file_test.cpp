#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <samewhere/input/camera_file.hpp>
#include <samewhere/input/test_folder.hpp>

namespace samewhere::input {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class CameraFile : public testing::Test {
 protected:
  std::string complaint_about(const std::string& text) {
    folder_.write("camera.txt", text);
    return complaint([&] { read_camera_file(folder_.at("camera.txt")); });
  }

  core::PinholeRadtan read(const std::string& name) {
    return std::get<core::PinholeRadtan>(read_camera_file(folder_.at(name)).camera);
  }

  TestFolder folder_;
};

TEST_F(CameraFile, TheMatrixAloneMeansNoDistortion) {
  folder_.write("camera.txt", "# K\n4.9e+02 0.0e+00 320\n\n0 510 240.5\n0 0 1\n");
  const core::PinholeRadtan camera = read("camera.txt");
  EXPECT_EQ(camera.fx_px, 490.0);
  EXPECT_EQ(camera.fy_px, 510.0);
  EXPECT_EQ(camera.cx_px, 320.0);
  EXPECT_EQ(camera.cy_px, 240.5);
  EXPECT_EQ(camera.k1, 0.0);
  EXPECT_EQ(camera.k3, 0.0);
  EXPECT_EQ(camera.width_px, 0);
}

TEST_F(CameraFile, TheDistortionFollowsInTheOrderK1K2P1P2K3) {
  folder_.write("camera.txt", "500 0 320\n0 500 240\n0 0 1\n0.1 -0.2 0.003 -0.004 0.5\n");
  const core::PinholeRadtan camera = read("camera.txt");
  EXPECT_EQ(camera.k1, 0.1);
  EXPECT_EQ(camera.k2, -0.2);
  EXPECT_EQ(camera.p1, 0.003);
  EXPECT_EQ(camera.p2, -0.004);
  EXPECT_EQ(camera.k3, 0.5);
}

TEST_F(CameraFile, WhatIsWrittenIsReadToTheLastDigit) {
  const core::PinholeRadtan camera{.fx_px = 500.0 / 3.0,
                                   .fy_px = 1e3 / 7.0,
                                   .cx_px = 0.1 + 0.2,
                                   .cy_px = 239.5,
                                   .k1 = -0.1 / 3.0,
                                   .k2 = 1e-7 / 3.0,
                                   .p1 = 2e-5,
                                   .p2 = -1.0 / 3e4,
                                   .k3 = 1e-22};
  folder_.write("written.txt", "# a comment\n" + camera_file_text(camera));
  const core::PinholeRadtan read = this->read("written.txt");
  EXPECT_EQ(read.fx_px, camera.fx_px);
  EXPECT_EQ(read.fy_px, camera.fy_px);
  EXPECT_EQ(read.cx_px, camera.cx_px);
  EXPECT_EQ(read.cy_px, camera.cy_px);
  EXPECT_EQ(read.k1, camera.k1);
  EXPECT_EQ(read.k2, camera.k2);
  EXPECT_EQ(read.p1, camera.p1);
  EXPECT_EQ(read.p2, camera.p2);
  EXPECT_EQ(read.k3, camera.k3);
}

TEST_F(CameraFile, TheSizeOfItsPicturesMayFollowWithOrWithoutDistortion) {
  folder_.write("camera.txt", "500 0 320\n0 500 240\n0 0 1\n640 480\n");
  core::PinholeRadtan camera = read("camera.txt");
  EXPECT_EQ(camera.width_px, 640);
  EXPECT_EQ(camera.height_px, 480);
  EXPECT_EQ(camera.k1, 0.0);
  camera.k1 = 0.25;
  folder_.write("written.txt", camera_file_text(camera));
  camera = read("written.txt");
  EXPECT_EQ(camera.width_px, 640);
  EXPECT_EQ(camera.height_px, 480);
  EXPECT_EQ(camera.k1, 0.25);
}

TEST_F(CameraFile, PicturesOfAnotherSizeAreRefusedWithBothSizes) {
  const auto read_for = [&](const cv::Size& size_px) {
    return complaint([&] {
      const auto camera = read_camera_file_for(folder_.at("camera.txt"), size_px, "walk/7.png");
      EXPECT_EQ(std::get<core::PinholeRadtan>(camera).width_px, size_px.width);
    });
  };
  folder_.write("camera.txt", "500 0 320\n0 500 240\n0 0 1\n640 480\n");
  EXPECT_EQ(read_for({640, 480}), "no error");
  EXPECT_THAT(read_for({1280, 960}),
              AllOf(HasSubstr("camera.txt: wrong calibration"), HasSubstr("640 x 480"),
                    HasSubstr("walk/7.png is 1280 x 960")));
  EXPECT_THAT(read_for({640, 481}), HasSubstr("walk/7.png is 640 x 481"));
  // files of old do not say it
  folder_.write("camera.txt", "500 0 320\n0 500 240\n0 0 1\n");
  EXPECT_EQ(read_for({1280, 960}), "no error");
}

TEST_F(CameraFile, AFieldOfViewThatHardlyALensHasIsWarnedOf) {
  const auto said_of = [&](const std::string& focal_px) {
    folder_.write("camera.txt", fmt::format("{0} 0 320\n0 {0} 240\n0 0 1\n", focal_px));
    testing::internal::CaptureStdout();
    read_camera_file_for(folder_.at("camera.txt"), {640, 480}, "1.png");
    return testing::internal::GetCapturedStdout();
  };
  EXPECT_EQ(said_of("500"), "");
  EXPECT_EQ(said_of("3600"), "");
  EXPECT_THAT(said_of("28171"), AllOf(HasSubstr("camera.txt"), HasSubstr("of 1.3 degrees")));
  EXPECT_THAT(said_of("60"), AllOf(HasSubstr("camera.txt"), HasSubstr("expected 10 to 150")));
}

TEST_F(CameraFile, WhatIsNoCameraMatrixIsNamedWithItsLine) {
  EXPECT_THAT(complaint_about("500 0 320\n0 500 240\n"), HasSubstr("found 2 rows"));
  EXPECT_THAT(complaint_about(""), HasSubstr("found 0 rows"));
  EXPECT_THAT(complaint_about("500 0 320\n0 500\n0 0 1\n"),
              AllOf(HasSubstr("camera.txt, line 2"), HasSubstr("found 2 values")));
  EXPECT_THAT(complaint_about("500 0 nan\n0 500 240\n0 0 1\n"),
              AllOf(HasSubstr("line 1"), HasSubstr("'nan'")));
  EXPECT_THAT(complaint_about("-500 0 320\n0 500 240\n0 0 1\n"), HasSubstr("fx > 0"));
  EXPECT_THAT(complaint_about("500 2 320\n0 500 240\n0 0 1\n"), HasSubstr("found 500 2 320"));
  EXPECT_THAT(complaint_about("500 0 320\n0 0 240\n0 0 1\n"), HasSubstr("fy > 0"));
  EXPECT_THAT(complaint_about("500 0 320\n0 500 240\n0 0 2\n"), HasSubstr("expected 0 0 1"));
  EXPECT_THAT(complaint_about("500 0 320\n0 500 240\n0 0 1\n0.1 0.2 0\n"),
              AllOf(HasSubstr("line 4"), HasSubstr("k1 k2 p1 p2, k3")));
  const std::string matrix = "500 0 320\n0 500 240\n0 0 1\n";
  EXPECT_THAT(complaint_about(matrix + "640 480\n0.1 0.2 0 0 0\n"),
              AllOf(HasSubstr("line 5"), HasSubstr("found 5 values, expected 2")));
  EXPECT_THAT(complaint_about(matrix + "0 480\n"),
              AllOf(HasSubstr("line 4"), HasSubstr("found 0 480"), HasSubstr("whole pixels")));
  EXPECT_THAT(complaint_about(matrix + "640.5 480\n"), HasSubstr("whole pixels"));
  EXPECT_THAT(complaint_about(matrix + "0 0 0 0 0\n640 480\n1\n"), HasSubstr("found 6 rows"));
}

}  // namespace
}  // namespace samewhere::input
