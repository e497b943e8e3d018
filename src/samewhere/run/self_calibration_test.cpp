#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <samewhere/geometry/camera.hpp>
#include <samewhere/run/self_calibration.hpp>

namespace samewhere::run {
namespace {

using testing::HasSubstr;

// Three grey pictures of one camera, or of two.
class Uncalibrated : public core::Source {
 public:
  explicit Uncalibrated(int num_cameras) : num_cameras_(num_cameras) {}
  core::SourceInfo info() const override {
    return {.name = "grey", .num_frames = 3, .num_cameras = num_cameras_};
  }
  core::Truth truth() const override { return {}; }
  std::optional<core::Frame> next() override {
    if (num_given_ == 3) return std::nullopt;
    core::Frame frame;
    frame.id = core::FrameId(num_given_++);
    frame.rig = std::make_shared<const core::Rig>();
    frame.images.assign(static_cast<std::size_t>(num_cameras_), cv::Mat(480, 640, CV_8UC1));
    return frame;
  }

 private:
  int num_cameras_;
  std::uint64_t num_given_ = 0;
};

TEST(SelfCalibration, TheFieldOfViewThatIsGivenMakesTheCamera) {
  std::unique_ptr<core::Source> source = std::make_unique<Uncalibrated>(1);
  pipeline::Config config;
  config.source = "grey";
  config.input.fov_deg = 90.0;
  testing::internal::CaptureStdout();
  const auto calibration = calibrate_if_unknown(source, config);
  EXPECT_THAT(testing::internal::GetCapturedStdout(),
              HasSubstr("no calibration; focal length 320.0 px from a horizontal field of view"));
  ASSERT_TRUE(calibration);
  EXPECT_FALSE(calibration->sigma_px);
  EXPECT_EQ(focal_length_figure(*calibration).value, "320.0 px, guessed");
  EXPECT_TRUE(source->info().is_calibrated);
  int num_frames = 0;
  while (const auto frame = source->next()) {
    EXPECT_NEAR(geometry::pinhole(frame->rig->cameras.at(0)).fx_px, 320.0, 1e-9);
    ++num_frames;
  }
  EXPECT_EQ(num_frames, 3) << "the picture whose size was asked for is given, too";
}

TEST(SelfCalibration, APairOfCamerasIsNotGuessed) {
  std::unique_ptr<core::Source> source = std::make_unique<Uncalibrated>(2);
  EXPECT_FALSE(calibrate_if_unknown(source, {}));
  EXPECT_FALSE(source->info().is_calibrated);
}

TEST(SelfCalibration, AnEstimateIsToldWithItsDeviationAndTheGuess) {
  SelfCalibration calibration{{640, 480, 612.44, 612.44, 319.5, 239.5}, 560.0, 3.06};
  EXPECT_EQ(focal_length_figure(calibration).value, "612.4 px +- 3.1 (guessed 560.0 px)");
}

}  // namespace
}  // namespace samewhere::run
