#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <samewhere/geometry/camera.hpp>
#include <samewhere/input/test_recording.hpp>

namespace samewhere::input {
namespace {

using testing::HasSubstr;

class OpenLoris : public Open {
 protected:
  OpenLoris() {
    for (const char* name : {"color/100.000000.png", "color/100.033000.png"})
      folder_.write_png(name, picture(32, 24));
    write_depth("aligned_depth/100.001000.png");
    folder_.write("color.txt",
                  "100.000000 color/100.000000.png\n100.033000 color/100.033000.png\n");
    folder_.write("aligned_depth.txt", "100.001000 aligned_depth/100.001000.png\n");
    folder_.write("groundtruth.txt",
                  "#Time px py pz qx qy qz qw\n99.9 1 0 0 0 0 0 1\n100.1 2 0 0 0 0 0 1\n");
    folder_.write("sensors.yaml",
                  "%YAML:1.0\nd400_color_optical_frame:\n   sensor_type: camera\n   fps: 30\n"
                  "   width: 32\n   height: 24\n   model: pinhole\n"
                  "   intrinsics: !!opencv-matrix\n      rows: 1\n      cols: 4\n      dt: d\n"
                  "      data: [ 30., 15.5,\n          31., 11.5 ]\n"
                  "   distortion_model: radial-tangential\n"
                  "   distortion_coefficients: !!opencv-matrix\n      rows: 1\n      cols: 4\n"
                  "      dt: d\n      data: [ 0., 0., 0., 0. ]\n");
    write_transforms("laser");
  }

  // base_link <- laser <- color, the second one written from the other end.
  void write_transforms(const std::string& name) {
    const std::string matrix =
        "   matrix: !!opencv-matrix\n     rows: 4\n     cols: 4\n     dt: d\n     data: ";
    folder_.write("trans_matrix.yaml",
                  "%YAML:1.0\ntrans_matrix:\n - parent_frame: base_link\n   child_frame: laser\n" +
                      matrix +
                      "[1., 0., 0., 0.2, 0., 1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1.]\n"
                      " - parent_frame: d400_color_optical_frame\n   child_frame: " +
                      name + "\n" + matrix +
                      "[0., -1., 0., 0., 0., 0., -1., 0., 1., 0., 0., 0., 0., 0., 0., 1.]\n");
  }
};

TEST_F(OpenLoris, ColourAlignedDepthCameraAndTruthComeTogether) {
  const auto source = open();
  EXPECT_EQ(source->info().format, "OpenLORIS-Scene");
  EXPECT_EQ(source->info().num_frames, 2);
  EXPECT_TRUE(source->info().is_calibrated);
  const std::vector<core::Frame> frames = read_all();
  ASSERT_TRUE(frames[0].depth_m);
  EXPECT_FLOAT_EQ(frames[0].depth_m->at<float>(5, 5), 2.5F);  // millimetres
  const core::Camera camera = frames[0].rig->cameras.front();
  EXPECT_EQ(geometry::focal_lengths_px(camera), Eigen::Vector2d(30.0, 31.0));
  EXPECT_EQ(geometry::centre_px(camera), Eigen::Vector2d(15.5, 11.5));
}

TEST_F(OpenLoris, TheTruthOfTheRobotBecomesThatOfTheCamera) {
  const core::Trajectory truth = open()->truth().trajectory;
  ASSERT_EQ(truth.size(), 2U);
  EXPECT_TRUE(
      truth[0].world_from_camera.translation.isApprox(Eigen::Vector3d(1.2, 0.0, 0.0), 1e-9));
  // the camera looks along the robot's x axis
  const Eigen::Vector3d ahead = truth[0].world_from_camera.rotation * Eigen::Vector3d::UnitZ();
  EXPECT_TRUE(ahead.isApprox(Eigen::Vector3d::UnitX(), 1e-9)) << ahead.transpose();
}

TEST_F(OpenLoris, TruthThatCannotBeBroughtToTheCameraIsLeftOut) {
  write_transforms("nowhere");
  EXPECT_THAT(said_on_opening(), HasSubstr("leads from base_link to no d400_color_optical_frame"));
  EXPECT_TRUE(open()->truth().trajectory.empty());
  std::filesystem::remove(folder_.at("trans_matrix.yaml"));
  EXPECT_THAT(said_on_opening(), HasSubstr("trans_matrix.yaml"));
  EXPECT_TRUE(open()->truth().trajectory.empty());
  folder_.write("trans_matrix.yaml", "trans_matrix: 3\n");
  EXPECT_THAT(said_on_opening(), HasSubstr("has no list trans_matrix"));
}

TEST_F(OpenLoris, ABrokenCalibrationIsRefused) {
  folder_.write("sensors.yaml",
                "d400_color_optical_frame:\n  width: 32\n  height: 24\n  intrinsics: [1, 2]\n");
  EXPECT_THAT(complaint_on_opening(), HasSubstr("found 2 values, expected fx cx fy cy"));
  folder_.write("sensors.yaml", "t265_fisheye1_optical_frame:\n  width: 32\n");
  EXPECT_THAT(complaint_on_opening(), HasSubstr("has no d400_color_optical_frame"));
}

TEST_F(OpenLoris, MissingImagesAreLeftOut) {
  folder_.write("color.txt", "100.000000 color/100.000000.png\n100.033000 color/gone.png\n");
  EXPECT_THAT(said_on_opening(), HasSubstr("1 of 2 colour images are left out"));
}

}  // namespace
}  // namespace samewhere::input
