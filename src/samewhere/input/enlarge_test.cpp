#include <memory>
#include <utility>

#include <gtest/gtest.h>

#include <samewhere/geometry/camera.hpp>
#include <samewhere/input/enlarge.hpp>

namespace samewhere::input {
namespace {

// One frame with depth, of a camera of this size.
class OneFrame : public core::Source {
 public:
  OneFrame(const cv::Size& size_px, bool is_calibrated) {
    core::Rig rig;
    if (is_calibrated) {
      rig.cameras = {core::PinholeRadtan{.width_px = size_px.width,
                                         .height_px = size_px.height,
                                         .fx_px = 260.0,
                                         .fy_px = 250.0,
                                         .cx_px = 0.5 * (size_px.width - 1.0),
                                         .cy_px = 0.5 * (size_px.height - 1.0),
                                         .k1 = 0.1}};
      rig.body_from_camera = {core::Rigid3{}};
    }
    frame_.id = core::FrameId(0);
    frame_.rig = std::make_shared<const core::Rig>(rig);
    frame_.images = {cv::Mat(size_px, CV_8UC3, cv::Scalar(10, 20, 30))};
    frame_.depth_m = cv::Mat(size_px, CV_32FC1, cv::Scalar(2.0));
    frame_.depth_m->colRange(size_px.width / 2, size_px.width) = 4.0;
  }

  core::SourceInfo info() const override { return {.name = "one", .num_frames = 1}; }
  core::Truth truth() const override { return {}; }
  std::optional<core::Frame> next() override {
    return std::exchange(is_given_, true) ? std::nullopt : std::optional(frame_);
  }

 private:
  core::Frame frame_;
  bool is_given_ = false;
};

core::Frame first_of(const cv::Size& size_px, bool is_calibrated = true) {
  return *enlarged(std::make_unique<OneFrame>(size_px, is_calibrated))->next();
}

TEST(Enlarge, BringsASmallPictureToTheUsualNumberOfPixels) {
  EXPECT_EQ(first_of({320, 240}).images[0].size(), cv::Size(640, 480));
  EXPECT_EQ(first_of({160, 120}).images[0].size(), cv::Size(640, 480));
  EXPECT_EQ(first_of({424, 240}).images[0].size(), cv::Size(737, 417));
}

TEST(Enlarge, LeavesPicturesThatAreLargeEnoughAsTheyAre) {
  for (const cv::Size size_px : {cv::Size(480, 360), cv::Size(540, 360), cv::Size(1280, 960)})
    EXPECT_EQ(first_of(size_px).images[0].size(), size_px);
}

TEST(Enlarge, LeavesPicturesWithoutCalibration) {
  EXPECT_EQ(first_of({320, 240}, false).images[0].size(), cv::Size(320, 240));
}

TEST(Enlarge, TheCameraSeesEachDirectionWhereItWas) {
  const core::Frame taken = *OneFrame({424, 240}, true).next();
  const core::Frame large = first_of({424, 240});
  const Eigen::Vector3d direction(0.3, -0.2, 1.0);
  const Eigen::Vector2d before = *geometry::project(taken.rig->cameras[0], direction);
  const Eigen::Vector2d now = *geometry::project(large.rig->cameras[0], direction);
  EXPECT_NEAR((now.x() + 0.5) / 737.0, (before.x() + 0.5) / 424.0, 1e-9);
  EXPECT_NEAR((now.y() + 0.5) / 417.0, (before.y() + 0.5) / 240.0, 1e-9);
  EXPECT_EQ(geometry::picture_size_px(large.rig->cameras[0]), Eigen::Vector2i(737, 417));
}

TEST(Enlarge, DepthIsNotMixedAcrossEdges) {
  const core::Frame large = first_of({320, 240});
  ASSERT_EQ(large.depth_m->size(), cv::Size(640, 480));
  for (int x = 0; x < 640; ++x) EXPECT_EQ(large.depth_m->at<float>(100, x), x < 320 ? 2.0F : 4.0F);
}

}  // namespace
}  // namespace samewhere::input
