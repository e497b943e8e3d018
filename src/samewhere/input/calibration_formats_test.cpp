#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <samewhere/core/random.hpp>
#include <samewhere/input/camera_file.hpp>
#include <samewhere/input/test_folder.hpp>

namespace samewhere::input {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class CalibrationFormats : public testing::Test {
 protected:
  CameraFile read(const std::string& text) {
    folder_.write("cam", text);
    return read_camera_file(folder_.at("cam"));
  }
  core::PinholeRadtan pinhole(const std::string& text) {
    return std::get<core::PinholeRadtan>(read(text).camera);
  }
  core::KannalaBrandt fisheye(const std::string& text) {
    return std::get<core::KannalaBrandt>(read(text).camera);
  }
  std::string complaint_about(const std::string& text) {
    return complaint([&] { read(text); });
  }

  TestFolder folder_;
};

void expect_lens(const core::PinholeRadtan& c, double k3) {
  EXPECT_EQ(c.fx_px, 517.5);
  EXPECT_EQ(c.fy_px, 516.5);
  EXPECT_EQ(c.cx_px, 318.5);
  EXPECT_EQ(c.cy_px, 255.25);
  EXPECT_EQ(c.k1, 0.25);
  EXPECT_EQ(c.k2, -0.5);
  EXPECT_EQ(c.p1, -0.005);
  EXPECT_EQ(c.p2, 0.0025);
  EXPECT_EQ(c.k3, k3);
}

void expect_size(const core::PinholeRadtan& c) {
  EXPECT_EQ(c.width_px, 640);
  EXPECT_EQ(c.height_px, 480);
}

const std::string kRows = "517.5 0 318.5\n0 516.5 255.25\n0 0 1\n";

TEST_F(CalibrationFormats, RowsWithFourFiveOrEightValuesOfDistortion) {
  expect_lens(pinhole(kRows + "0.25 -0.5 -0.005 0.0025\n"), 0.0);
  expect_lens(pinhole(kRows + "0.25 -0.5 -0.005 0.0025 0.125\n"), 0.125);
  const core::PinholeRadtan c =
      pinhole(kRows + "0.25 -0.5 -0.005 0.0025 0.125 0.03 0.02 0.01\n640 480");
  expect_lens(c, 0.125);
  expect_size(c);
  EXPECT_EQ(c.k4, 0.03);
  EXPECT_EQ(c.k6, 0.01);
  expect_lens(pinhole("517.5 516.5 318.5 255.25 0.25 -0.5 -0.005 0.0025"), 0.0);
  EXPECT_EQ(pinhole("517.5 516.5 318.5 255.25").k1, 0.0);
}

TEST_F(CalibrationFormats, RowsOfAFisheyeAndOfTheDepthFactor) {
  const CameraFile file =
      read("depth_factor 5000\n" + kRows + "fisheye 0.01 -0.02 0.03 -0.004\n640 480");
  const auto& c = std::get<core::KannalaBrandt>(file.camera);
  EXPECT_EQ(c.fy_px, 516.5);
  EXPECT_EQ(c.k1, 0.01);
  EXPECT_EQ(c.k4, -0.004);
  EXPECT_EQ(c.width_px, 640);
  EXPECT_EQ(file.depth_units_per_m, 5000.0);
  EXPECT_EQ(read(kRows).depth_units_per_m, std::nullopt);
  EXPECT_THAT(complaint_about(kRows + "depth_factor 0\n"), HasSubstr("0 depth units per metre"));
  EXPECT_THAT(complaint_about(kRows + "depth_factor nan\n"), HasSubstr("'nan'"));
  EXPECT_THAT(complaint_about(kRows + "fisheye 1 2 3\n"), HasSubstr("k1 k2 k3 k4"));
}

TEST_F(CalibrationFormats, WhatIsWrittenIsReadToTheLastDigit) {
  core::Random random(5);
  for (int i = 0; i < 20; ++i) {
    core::PinholeRadtan lens{640,        480,        500.0 / 3.0,
                             1e3 / 7.0,  0.1 + 0.2,  239.5,
                             0.1,        0.02 / 3.0, random.uniform(-1e-3, 1e-3),
                             1e-7 / 3.0, 1e-3};
    lens.k4 = random.uniform(0.0, 0.01);
    lens.k5 = lens.k6 = 1e-9 / 7.0;
    const core::PinholeRadtan read_lens = pinhole(camera_file_text(lens));
    EXPECT_EQ(read_lens.fx_px, lens.fx_px);
    EXPECT_EQ(read_lens.p1, lens.p1);
    EXPECT_EQ(read_lens.k4, lens.k4);
    EXPECT_EQ(read_lens.k6, lens.k6);
    const core::KannalaBrandt round{
        640,   480,        500.0 / 3.0, 250.0, 319.5,
        239.5, 0.01 / 3.0, 1e-7,        0.0,   random.uniform(-1e-6, 1e-6)};
    const core::KannalaBrandt read_round = fisheye(camera_file_text(round));
    EXPECT_EQ(read_round.fx_px, round.fx_px);
    EXPECT_EQ(read_round.k1, round.k1);
    EXPECT_EQ(read_round.k4, round.k4);
    EXPECT_EQ(read_round.height_px, 480);
  }
}

TEST_F(CalibrationFormats, OrbSlamYaml) {
  const std::string text =
      "%YAML:1.0\n\n#----\nCamera.type: \"PinHole\"\nCamera.fx: 517.5\nCamera.fy: 516.5\n"
      "Camera.cx: 318.5\nCamera.cy: 255.25\nCamera.k1: 0.25\nCamera.k2: -0.5\nCamera.p1: -0.005\n"
      "Camera.p2: 0.0025\nCamera.k3: 0.125\nCamera.width: 640\nCamera.height: 480\n"
      "ORBextractor.nLevels:\t8\nDepthMapFactor: 5000.0\n";
  expect_lens(pinhole(text), 0.125);
  expect_size(pinhole(text));
  EXPECT_EQ(read(text).depth_units_per_m, 5000.0);
  const std::string third =
      "%YAML:1.0\nCamera.type: \"KannalaBrandt8\"\nCamera1.fx: 190.9\nCamera1.fy: 190.9\n"
      "Camera1.cx: 254.9\nCamera1.cy: 256.8\nCamera1.k1: 0.0034\nCamera1.k2: 0.0007\n"
      "Camera1.k3: -0.002\nCamera1.k4: 0.0002\nCamera.width: 512\nCamera.height: 512\n"
      "RGBD.DepthMapFactor: 1000\nTbc: !!opencv-matrix\n   rows: 1\n   cols: 1\n   dt: f\n"
      "   data: [1]\n";
  EXPECT_EQ(fisheye(third).k3, -0.002);
  EXPECT_EQ(read(third).depth_units_per_m, 1000.0);
  EXPECT_THAT(complaint_about("Camera.fx: 500\nCamera.fy: 500\nCamera.cx: 300\n"),
              HasSubstr("has no Camera.cy"));
}

TEST_F(CalibrationFormats, OpenCvYamlXmlAndJson) {
  const std::string text =
      "%YAML:1.0\n---\nimage_width: 640\nimage_height: 480\ncamera_matrix: !!opencv-matrix\n"
      "   rows: 3\n   cols: 3\n   dt: d\n   data: [ 517.5, 0., 318.5, 0., 516.5, 255.25, 0., 0., "
      "1. "
      "]\ndistortion_coefficients: !!opencv-matrix\n   rows: 1\n   cols: 5\n   dt: d\n"
      "   data: [ 0.25, -0.5, -0.005, 0.0025, 0.125 ]\n";
  expect_lens(pinhole(text), 0.125);
  expect_size(pinhole(text));
  const std::string xml =
      "<?xml version=\"1.0\"?>\n<opencv_storage>\n<image_width>640</image_width>\n"
      "<image_height>480</image_height>\n<K type_id=\"opencv-matrix\"><rows>3</rows><cols>3</cols>"
      "<dt>d</dt><data>517.5 0. 318.5 0. 516.5 255.25 0. 0. 1.</data></K>\n"
      "<D type_id=\"opencv-matrix\"><rows>4</rows><cols>1</cols><dt>d</dt>"
      "<data>0.25 -0.5 -0.005 0.0025</data></D>\n</opencv_storage>\n";
  expect_lens(pinhole(xml), 0.0);
  expect_size(pinhole(xml));
  const std::string json =
      "{\n\t\"camera_matrix\": [[517.5, 0, 318.5], [0, 516.5, 255.25], [0, 0, 1]],\n"
      "\t\"dist_coeffs\": [[0.25, -0.5, -0.005, 0.0025, 0.125]]\n}\n";
  expect_lens(pinhole(json), 0.125);
}

TEST_F(CalibrationFormats, RosCameraInfo) {
  const auto text = [](const std::string& model, const std::string& d) {
    return "image_width: 640\nimage_height: 480\ncamera_name: cam\ncamera_matrix:\n  rows: 3\n"
           "  cols: 3\n  data: [517.5, 0, 318.5, 0, 516.5, 255.25, 0, 0, 1]\ndistortion_model: " +
           model + "\ndistortion_coefficients:\n  rows: 1\n  cols: 5\n  data: [" + d + "]\n";
  };
  expect_lens(pinhole(text("plumb_bob", "0.25, -0.5, -0.005, 0.0025, 0.125")), 0.125);
  EXPECT_EQ(pinhole(text("rational_polynomial", "0.1, 0, 0, 0, 0, 0.2, 0, 0")).k4, 0.2);
  EXPECT_EQ(fisheye(text("equidistant", "0.01, 0, 0, 0.001")).k4, 0.001);
  EXPECT_THAT(complaint_about(text("omni", "0, 0, 0, 0")),
              AllOf(HasSubstr("line 8"), HasSubstr("camera model omni")));
  EXPECT_THAT(complaint_about(text("plumb_bob", "0.25, -0.5")), HasSubstr("2 distortion values"));
  EXPECT_THAT(complaint_about(text("equidistant", "0, 0, 0, 0, 1")), HasSubstr("4 of a fisheye"));
}

TEST_F(CalibrationFormats, KalibrsFirstCameraIsTaken) {
  const std::string text =
      "cam0:\n  camera_model: pinhole\n  distortion_coeffs: [0.25, -0.5, -0.005, 0.0025]\n"
      "  distortion_model: radtan\n  intrinsics: [517.5, 516.5, 318.5, 255.25]\n"
      "  resolution: [640, 480]\n";
  expect_lens(pinhole(text), 0.0);
  expect_size(pinhole(text));
  testing::internal::CaptureStdout();
  expect_lens(pinhole(text + "cam1:\n  intrinsics: [1, 1, 1, 1]\n"), 0.0);
  EXPECT_THAT(testing::internal::GetCapturedStdout(), HasSubstr("cam0 is taken"));
}

TEST_F(CalibrationFormats, ColmapWithItsCentreOfPixels) {
  const core::PinholeRadtan c =
      pinhole("# cameras\n1 OPENCV 640 480 517.5 516.5 319 255.75 0.25 -0.5 -0.005 0.0025\n");
  expect_lens(c, 0.0);
  expect_size(c);
  EXPECT_EQ(pinhole("1 SIMPLE_PINHOLE 640 480 500 320 240").fy_px, 500.0);
  EXPECT_EQ(pinhole("1 SIMPLE_PINHOLE 640 480 500 320 240").cy_px, 239.5);
  EXPECT_EQ(pinhole("1 RADIAL 640 480 500 320 240 0.1 0.2").k2, 0.2);
  EXPECT_EQ(pinhole("1 FULL_OPENCV 640 480 500 500 320 240 0.1 0 0 0 0 0.1 0 0").k4, 0.1);
  EXPECT_EQ(fisheye("1 OPENCV_FISHEYE 640 480 250 250 320 240 0.1 0.02 0 0").k2, 0.02);
  EXPECT_THAT(complaint_about("1 PINHOLE 640 480 500 500 320 240\n2 PINHOLE 64 48 50 50 32 24\n"),
              HasSubstr("holds 2 cameras"));
  EXPECT_THAT(complaint_about("1 FOV 640 480 500 500 320 240 0.1"), HasSubstr("FOV, expected one"));
  EXPECT_THAT(complaint_about("1 PINHOLE 640 480 500 320 240"), HasSubstr("expected the 8 of"));
  EXPECT_THAT(complaint_about("1 PINHOLE 6e9 480 500 500 320 240"), HasSubstr("whole pixels"));
}

TEST_F(CalibrationFormats, JsonOfNerfstudioOpen3dAndPlainKeys) {
  EXPECT_EQ(pinhole("{\"fx\": 500, \"fy\": 510, \"cx\": 320, \"cy\": 240}").fy_px, 510.0);
  EXPECT_EQ(pinhole("{\"fx\": 500, \"fy\": 510, \"ppx\": 320, \"ppy\": 240, \"width\": 640, "
                    "\"height\": 480, \"model\": \"distortion.brown_conrady\", "
                    "\"coeffs\": [0.1,0,0,0,0]}")
                .k1,
            0.1);
  const std::string nerf =
      "{\"w\": 640, \"h\": 480, \"fl_x\": 500.0, \"fl_y\": 500.0, \"cx\": 320.0, \"cy\": 240.0, "
      "\"k1\": 0.1, \"camera_model\": \"OPENCV\", \"frames\": [{\"file_path\": \"a.png\"}]}";
  EXPECT_EQ(pinhole(nerf).k1, 0.1);
  EXPECT_EQ(pinhole(nerf).cx_px, 319.5);
  const core::PinholeRadtan open3d = pinhole(
      "{\"width\": 640, \"height\": 480, \"intrinsic_matrix\": [525, 0, 0, 0, 526, 0, 319.5, "
      "239.5, "
      "1]}");
  EXPECT_EQ(open3d.fy_px, 526.0);
  EXPECT_EQ(open3d.cx_px, 319.5);
  const CameraFile replica = read(
      "{\"camera\": {\"w\": 1200, \"h\": 680, \"fx\": 600, \"fy\": 600, \"cx\": 599.5, "
      "\"cy\": 339.5, \"png_depth_scale\": 6553.5}}");
  EXPECT_EQ(replica.depth_units_per_m, 6553.5);
}

TEST_F(CalibrationFormats, AFileThatIsNoneListsWhatIsRead) {
  EXPECT_THAT(complaint_about("hello\n"),
              AllOf(HasSubstr("no camera file"), HasSubstr("ORB-SLAM"), HasSubstr("COLMAP")));
  EXPECT_THAT(complaint_about("name: kitchen\n"), HasSubstr("none of the keys"));
  EXPECT_THAT(complaint_about(std::string("\0\1\2", 3)), HasSubstr("no camera file"));
  EXPECT_THAT(complaint_about("<opencv_storage></opencv"), HasSubstr("not XML of OpenCV"));
}

TEST_F(CalibrationFormats, NumbersAreCheckedInEveryFormat) {
  EXPECT_THAT(complaint_about(kRows + "1e200 0 0 0 0\n"), HasSubstr("k1 = 1e+200"));
  EXPECT_THAT(complaint_about(kRows + "0 0 0 0 1e100\n"), HasSubstr("k3 = 1e+100"));
  EXPECT_THAT(complaint_about("fx: .nan\nfy: 1\ncx: 1\ncy: 1\n"), HasSubstr("finite number"));
  EXPECT_THAT(complaint_about("fx: 500\nfx: 600\nfy: 1\ncx: 1\ncy: 1\n"), HasSubstr("fx twice"));
  EXPECT_THAT(complaint_about("{\"fx\": [500, 1], \"fy\": 1}"), HasSubstr("found 2 values"));
  EXPECT_THAT(complaint_about("{\"K\": [1, 2, 3]}"), HasSubstr("fx 0 cx 0 fy cy 0 0 1"));
  EXPECT_THAT(complaint_about("{\"K\": [[[[1]]]]}"), HasSubstr("plain values"));
}

TEST_F(CalibrationFormats, DamagedFilesNeverCrash) {
  const std::vector<std::string> good = {
      "%YAML:1.0\n---\nK: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n   data: [ 517.5, 0., "
      "318.5, 0., 516.5, 255.25, 0., 0., 1. ]\nD: [0, 0, 0, 0]\n",
      "cam0:\n  camera_model: pinhole\n  distortion_coeffs: [0.25, -0.5, -0.005, 0.0025]\n"
      "  distortion_model: radtan\n  intrinsics: [517.5, 516.5, 318.5, 255.25]\n",
      "{\"w\": 640, \"h\": 480, \"fl_x\": 500.0, \"fl_y\": 500.0, \"cx\": 320.0, \"cy\": 240.0}",
      "<?xml version=\"1.0\"?>\n<opencv_storage>\n<K "
      "type_id=\"opencv-matrix\"><rows>3</rows><cols>3"
      "</cols><dt>d</dt><data>517.5 0. 318.5 0. 516.5 255.25 0. 0. "
      "1.</data></K></opencv_storage>\n",
      "1 OPENCV 640 480 517.5 516.5 319 255.75 0.25 -0.5 -0.005 0.0025\n"};
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    core::Random random(seed);
    const std::string& whole = good[seed % good.size()];
    std::string text = whole.substr(0, whole.size() - random.index(whole.size() / 4));
    for (int i = 0; i < 3; ++i) {
      text[random.index(text.size())] = static_cast<char>(random.index(256));
    }
    SCOPED_TRACE(fmt::format("seed {}", seed));
    EXPECT_THAT(complaint_about(text), testing::AnyOf("no error", HasSubstr("/cam")));
  }
}

}  // namespace
}  // namespace samewhere::input
