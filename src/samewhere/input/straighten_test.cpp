#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include <samewhere/core/rectified_pair.hpp>
#include <samewhere/geometry/camera.hpp>
#include <samewhere/input/rectify.hpp>
#include <samewhere/input/straighten.hpp>
#include <samewhere/input/test_folder.hpp>

namespace samewhere::input {
namespace {

constexpr core::KannalaBrandt kFisheye{.width_px = 320,
                                       .height_px = 320,
                                       .fx_px = 119.0,
                                       .fy_px = 119.0,
                                       .cx_px = 159.0,
                                       .cy_px = 160.5,
                                       .k1 = 0.0035,
                                       .k2 = 0.0007,
                                       .k3 = -0.002,
                                       .k4 = 0.0002};

// A smooth world without distance: what is seen in a direction.
float brightness(const Eigen::Vector3d& direction) {
  return static_cast<float>(128.0 + 50.0 * std::sin(6.0 * direction.x()) +
                            50.0 * std::cos(5.0 * direction.y()));
}

// What a camera sees of it, turned by `world_from_camera`.
cv::Mat picture(const core::Camera& camera, const core::Rigid3& world_from_camera = {}) {
  const Eigen::Vector2i size_px = geometry::picture_size_px(camera);
  cv::Mat image(size_px.y(), size_px.x(), CV_8UC1);
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      const Eigen::Vector3d direction =
          world_from_camera.rotation * geometry::bearing(camera, Eigen::Vector2d(x, y));
      image.at<std::uint8_t>(y, x) = cv::saturate_cast<std::uint8_t>(brightness(direction));
    }
  }
  return image;
}

double difference_of_whole(const cv::Mat& a, const cv::Mat& b) {
  return cv::norm(a, b, cv::NORM_L1) / static_cast<double>(a.total());
}

class OneFrame : public core::Source {
 public:
  explicit OneFrame(core::Frame frame) : frame_(std::move(frame)) {}
  core::SourceInfo info() const override { return {.name = "one"}; }
  core::Truth truth() const override { return {}; }
  std::optional<core::Frame> next() override { return frame_; }

 private:
  core::Frame frame_;
};

core::Frame passed(const core::Rig& rig, std::vector<cv::Mat> images,
                   const std::optional<cv::Mat>& depth_m = {}) {
  core::Frame frame;
  frame.id = core::FrameId(0);
  frame.rig = std::make_shared<const core::Rig>(rig);
  frame.images = std::move(images);
  frame.depth_m = depth_m;
  return *rectified(std::make_unique<OneFrame>(std::move(frame)))->next();
}

TEST(Straighten, AFisheyesPictureBecomesThatOfAnIdealPinhole) {
  const core::Frame frame =
      passed({.cameras = {kFisheye}, .body_from_camera = {{}}}, {picture(kFisheye)});
  const core::Camera& pinhole = frame.rig->cameras[0];
  ASSERT_TRUE(geometry::is_brown(pinhole));
  EXPECT_NEAR(geometry::horizontal_field_of_view_rad(pinhole) * 180.0 / 3.14159, kWidestPinhole_deg,
              0.5);
  EXPECT_LT(difference_of_whole(frame.images[0], picture(pinhole)), 1.0);
}

TEST(Straighten, SoDoesThatOfARationalLens) {
  core::PinholeRadtan lens{320, 240, 250.0, 250.0, 160.0, 120.0, 0.5, 0.1, 1e-3, -1e-3, 0.01};
  lens.k4 = 0.8;
  lens.k5 = 0.3;
  const core::Frame frame = passed({.cameras = {lens}, .body_from_camera = {{}}}, {picture(lens)});
  EXPECT_TRUE(geometry::is_brown(frame.rig->cameras[0]));
  EXPECT_EQ(geometry::pinhole(frame.rig->cameras[0]).k1, 0.0);
  EXPECT_LT(difference_of_whole(frame.images[0], picture(frame.rig->cameras[0])), 1.0);
}

TEST(Straighten, DepthAlongTheOpticalAxisFollows) {
  const cv::Mat depth_m(320, 320, CV_32FC1, cv::Scalar(2.0));
  const core::Frame frame =
      passed({.cameras = {kFisheye}, .body_from_camera = {{}}}, {picture(kFisheye)}, depth_m);
  EXPECT_EQ(cv::countNonZero(*frame.depth_m != 2.0), 0);
}

TEST(Straighten, APairOfFisheyesIsRectified) {
  const core::Rigid3 left_from_right{core::exp_so3({0.02, -0.03, 0.04}), {0.11, 0.004, -0.006}};
  core::KannalaBrandt second = kFisheye;
  second.cx_px += 3.0;
  const core::Frame frame =
      passed({.cameras = {kFisheye, second}, .body_from_camera = {core::Rigid3{}, left_from_right}},
             {picture(kFisheye), picture(second, left_from_right)});
  ASSERT_TRUE(core::is_rectified_pair(*frame.rig));
  // of a world infinitely far away both see the same
  EXPECT_LT(difference_of_whole(frame.images[0], frame.images[1]), 1.5);
}

TEST(Straighten, BrownsCameraPassesAsItIs) {
  const core::PinholeRadtan lens{320, 240, 250.0, 250.0, 160.0, 120.0, 0.1, -0.2};
  const cv::Mat taken = picture(lens);
  const core::Frame frame = passed({.cameras = {lens}, .body_from_camera = {{}}}, {taken});
  EXPECT_EQ(frame.images[0].data, taken.data);
  EXPECT_EQ(geometry::pinhole(frame.rig->cameras[0]).k2, -0.2);
}

}  // namespace
}  // namespace samewhere::input
