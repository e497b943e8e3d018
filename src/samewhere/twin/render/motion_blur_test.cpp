#include <cstring>

#include <gtest/gtest.h>

#include <samewhere/twin/building/test_room.hpp>
#include <samewhere/twin/render/motion_blur.hpp>

namespace samewhere::twin {
namespace {

constexpr double kExposure_s = 0.01;
constexpr float kDepth_m = 2.0F;
constexpr int kEdge_px = 81;  // the first white column

// A wall straight ahead, black on the left and white on the right.
View view_of_edge() {
  View view{.radiance = cv::Mat::zeros(kSmallCamera.height_px, kSmallCamera.width_px, CV_32FC3),
            .depth_m = cv::Mat(kSmallCamera.height_px, kSmallCamera.width_px, CV_32F)};
  view.depth_m.setTo(kDepth_m);
  view.radiance.colRange(kEdge_px, kSmallCamera.width_px).setTo(cv::Scalar::all(1.0));
  return view;
}

// Speed of the camera that moves the wall by so many pixels.
double speed_for(double shift_px) { return shift_px * kDepth_m / (130.0 * kExposure_s); }

TEST(MotionBlur, AnUprightEdgeUnderSidewaysMotionBecomesARampOfTheRightWidth) {
  for (const double shift_px : {4.0, 8.0, 12.0}) {
    const CameraMotion motion{.velocity_m_s = {speed_for(shift_px), 0.0, 0.0}};
    const cv::Mat blurred = blur_by_motion(view_of_edge(), kSmallCamera, motion, kExposure_s);
    // the mean of a ramp's derivative is its middle, its spread that of a uniform distribution
    double mean_px = 0.0;
    double squared = 0.0;
    for (int x = 1; x < blurred.cols; ++x) {
      const double rise = blurred.at<cv::Vec3f>(60, x)[0] - blurred.at<cv::Vec3f>(60, x - 1)[0];
      EXPECT_GE(rise, 0.0);
      EXPECT_LT(rise, 1.8 / shift_px) << "a ramp, no steps";
      mean_px += rise * (x - 0.5);
      squared += rise * (x - 0.5) * (x - 0.5);
    }
    EXPECT_NEAR(mean_px, kEdge_px - 0.5, 0.1);
    const double width_px = std::sqrt(12.0 * (squared - mean_px * mean_px));
    EXPECT_NEAR(width_px, shift_px, 1.0);
  }
}

TEST(MotionBlur, MotionAlongTheEdgeAndRollAboutItsMiddleLeaveItSharp) {
  const View view = view_of_edge();
  const CameraMotion along{.velocity_m_s = {0.0, speed_for(8.0), 0.0}};
  const CameraMotion pitch{.angular_velocity_rad_s = {6.0, 0.0, 0.0}};
  for (const auto& motion : {along, pitch}) {
    const cv::Mat blurred = blur_by_motion(view, kSmallCamera, motion, kExposure_s);
    EXPECT_LT(blurred.at<cv::Vec3f>(60, kEdge_px - 1)[0], 0.02F);
    EXPECT_GT(blurred.at<cv::Vec3f>(60, kEdge_px)[0], 0.98F);
  }
}

TEST(MotionBlur, TurningBlursNearAndFarAlike) {
  View near = view_of_edge();
  View far = view_of_edge();
  far.depth_m.setTo(20.0F);
  const CameraMotion turn{.angular_velocity_rad_s = {0.0, 6.0, 0.0}};
  const cv::Mat a = blur_by_motion(near, kSmallCamera, turn, kExposure_s);
  const cv::Mat b = blur_by_motion(far, kSmallCamera, turn, kExposure_s);
  EXPECT_EQ(std::memcmp(a.data, b.data, a.total() * a.elemSize()), 0);
  // 0.06 rad of 130 px: the edge is 7.8 px wide
  EXPECT_GT(a.at<cv::Vec3f>(60, kEdge_px - 3)[0], 0.05F);
  EXPECT_EQ(a.at<cv::Vec3f>(60, kEdge_px - 6)[0], 0.0F);
}

TEST(MotionBlur, LessThanHalfAPixelIsLeftAlone) {
  const View view = view_of_edge();
  const CameraMotion slow{.velocity_m_s = {speed_for(0.45), 0.0, 0.0}};
  const cv::Mat blurred = blur_by_motion(view, kSmallCamera, slow, kExposure_s);
  EXPECT_EQ(std::memcmp(blurred.data, view.radiance.data, blurred.total() * blurred.elemSize()), 0);
}

TEST(MotionBlur, TheMotionBetweenTwoPosesLeadsFromOneToTheOther) {
  const core::Rigid3 first = looking({1.0, 2.0, 1.5}, 0.7);
  const core::Rigid3 step{core::exp_so3({0.01, -0.02, 0.005}), {0.02, -0.01, 0.08}};
  const CameraMotion motion = motion_between(first, first * step, 0.1);
  EXPECT_TRUE(motion.velocity_m_s.isApprox(Eigen::Vector3d(0.2, -0.1, 0.8), 1e-9));
  EXPECT_TRUE(motion.angular_velocity_rad_s.isApprox(Eigen::Vector3d(0.1, -0.2, 0.05), 1e-9));
}

}  // namespace
}  // namespace samewhere::twin
