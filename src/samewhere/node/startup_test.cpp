#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/input/test_folder.hpp>
#include <samewhere/node/startup.hpp>
#include <samewhere/node/transforms.hpp>

namespace samewhere::node {
namespace {

using testing::HasSubstr;

constexpr double kFocalLength_px = 400.0;
constexpr double kBaseline_m = 0.12;

messages::CameraInfo info_of_camera() {
  return {.height = 480,
          .width = 640,
          .distortion_model = "plumb_bob",
          .d = {0, 0, 0, 0, 0},
          .k = {kFocalLength_px, 0, 320, 0, kFocalLength_px, 240, 0, 0, 1},
          .r = {1, 0, 0, 0, 1, 0, 0, 0, 1},
          .p = {kFocalLength_px, 0, 320, 0, 0, kFocalLength_px, 240, 0, 0, 0, 1, 0}};
}

messages::CameraInfo info_of_right_camera() {
  messages::CameraInfo info = info_of_camera();
  info.p[3] = -kFocalLength_px * kBaseline_m;
  return info;
}

Config stereo_config() {
  return {.cameras = Cameras::kStereo, .frame_rate_hz = 20.0, .tf_wait_s = 0.5};
}

FrameSet pair_at(double stamp_s, const std::string& right_frame = "right_optical") {
  return {{stamp_s, "left_optical", {}}, Picture{stamp_s, right_frame, {}}};
}

messages::TransformStamped place_of(const std::string& parent, const std::string& child,
                                    const Pose& parent_from_child) {
  return transform_message(parent, child, 0.0, parent_from_child);
}

Pose beside(double x_m) {
  Pose pose = Pose::Identity();
  pose.translation().x() = x_m;
  return pose;
}

Pose left_from_right(const Setup& setup) {
  const auto& cameras = setup.calibration.cameras;
  return cameras.at(0).body_from_camera.inverse() * cameras.at(1).body_from_camera;
}

// A pair whose camera is on the robot by /tf_static.
class StartupOfAPair : public testing::Test {
 protected:
  StartupOfAPair() { transforms_.add(place_of("base_link", "left_optical", beside(1.0)), true); }

  void take(const messages::CameraInfo& left, const messages::CameraInfo& right) {
    startup_.take_info(Stream::kFirst, left);
    startup_.take_info(Stream::kSecond, right);
  }

  Startup startup_{stereo_config()};
  input::Transforms transforms_;
};

TEST_F(StartupOfAPair, PlacesTheRightCameraByItsCalibration) {
  take(info_of_camera(), info_of_right_camera());
  startup_.add(pair_at(0.0));
  const auto setup = startup_.setup(transforms_);
  ASSERT_TRUE(setup) << setup.error();
  EXPECT_EQ(setup->base_frame, "base_link");
  EXPECT_NEAR(setup->camera_from_base.translation().x(), -1.0, 1e-12);
  EXPECT_LT((left_from_right(*setup).matrix() - beside(kBaseline_m).matrix()).norm(), 1e-12);
}

// A quarter of a turn about the optical axis.
TEST_F(StartupOfAPair, TurnsRawCamerasByTheirRectification) {
  messages::CameraInfo right = info_of_right_camera();
  right.r = {0, -1, 0, 1, 0, 0, 0, 0, 1};
  take(info_of_camera(), right);
  startup_.add(pair_at(0.0));
  const auto setup = startup_.setup(transforms_);
  ASSERT_TRUE(setup) << setup.error();
  const Eigen::Vector3d x_in_left = left_from_right(*setup) * Eigen::Vector3d(1, 0, 3);
  EXPECT_LT((x_in_left - Eigen::Vector3d(kBaseline_m, 1, 3)).norm(), 1e-12);
}

TEST_F(StartupOfAPair, PlacesTheRightCameraByTransformsWhereItsCalibrationDoesNotTell) {
  take(info_of_camera(), info_of_camera());
  startup_.add(pair_at(0.0));
  auto setup = startup_.setup(transforms_);
  ASSERT_FALSE(setup);
  EXPECT_EQ(setup.error(), "waiting for /tf_static: left_optical to right_optical");
  transforms_.add(place_of("left_optical", "right_optical", beside(0.3)), true);
  setup = startup_.setup(transforms_);
  ASSERT_TRUE(setup) << setup.error();
  EXPECT_LT((left_from_right(*setup).matrix() - beside(0.3).matrix()).norm(), 1e-12);
}

TEST_F(StartupOfAPair, RefusesAPairWithoutADistance) {
  take(info_of_camera(), info_of_camera());
  startup_.add(pair_at(0.0));
  startup_.add(pair_at(1.0));
  EXPECT_THAT(input::complaint([&] { startup_.setup(transforms_).has_value(); }),
              HasSubstr("right/camera_info: P[3] of the right camera is 0"))
      << "after node.tf_wait_s";
}

TEST_F(StartupOfAPair, RefusesAPairOfOneFrameAtOnce) {
  take(info_of_camera(), info_of_camera());
  startup_.add(pair_at(0.0, "left_optical"));
  EXPECT_THAT(input::complaint([&] { startup_.setup(transforms_).has_value(); }),
              HasSubstr("right/camera_info: P[3]"));
}

TEST(Startup, RefusesACameraThatIsNotCalibrated) {
  Startup startup(stereo_config());
  messages::CameraInfo info = info_of_camera();
  info.k = {};
  EXPECT_THAT(input::complaint([&] { startup.take_info(Stream::kSecond, info); }),
              HasSubstr("right/camera_info: focal length 0"));
}

TEST(Startup, RoundsTheMeasuredFrameRateToAWholeNumber) {
  Config config = stereo_config();
  config.cameras = Cameras::kMono;
  config.frame_rate_hz = 0.0;
  config.tf_wait_s = 0.0;
  for (const auto& [period_s, rate_hz] : {std::pair{1.0 / 29.97, 30.0}, {1.0 / 7.5, 7.5}}) {
    Startup startup(config);
    startup.take_info(Stream::kFirst, info_of_camera());
    for (int i = 0; i < 8; ++i) {
      EXPECT_FALSE(startup.setup({}));
      startup.add({{i * period_s, "left_optical", {}}, std::nullopt});
    }
    const auto setup = startup.setup({});
    ASSERT_TRUE(setup) << setup.error();
    EXPECT_NEAR(setup->calibration.frame_rate_hz, rate_hz, 1e-9);
  }
}

}  // namespace
}  // namespace samewhere::node
