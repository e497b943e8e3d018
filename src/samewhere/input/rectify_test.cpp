#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <samewhere/geometry/test_board.hpp>
#include <samewhere/input/rectify.hpp>
#include <samewhere/input/test_folder.hpp>

namespace samewhere::input {
namespace {

using testing::HasSubstr;

constexpr geometry::Board kBoard{.num_columns = 9, .num_rows = 6, .square_m = 0.025};
constexpr core::PinholeRadtan kLeft{.width_px = 640,
                                    .height_px = 480,
                                    .fx_px = 458.0,
                                    .fy_px = 457.0,
                                    .cx_px = 322.0,
                                    .cy_px = 245.0,
                                    .k1 = -0.28,
                                    .k2 = 0.07};
constexpr core::PinholeRadtan kRight{.width_px = 640,
                                     .height_px = 480,
                                     .fx_px = 470.0,
                                     .fy_px = 468.0,
                                     .cx_px = 310.0,
                                     .cy_px = 229.0,
                                     .k1 = -0.2,
                                     .k2 = 0.05,
                                     .p1 = 0.001,
                                     .p2 = -0.0005};

// Two cameras that are not aligned: the right one is turned, shifted and has another lens.
core::Rig crooked_rig() {
  const core::Rigid3 body_from_left{core::exp_so3({0.1, -0.2, 1.5}), {0.02, -0.06, 0.01}};
  const core::Rigid3 left_from_right{core::exp_so3({0.02, -0.03, 0.04}), {0.11, 0.004, -0.006}};
  return {.cameras = {kLeft, kRight},
          .body_from_camera = {body_from_left, body_from_left * left_from_right}};
}

core::Rig straight_rig() {
  core::PinholeRadtan ideal = kLeft;
  ideal.k1 = ideal.k2 = 0.0;
  return {.cameras = {ideal, ideal},
          .body_from_camera = {core::Rigid3{}, {Eigen::Quaterniond::Identity(), {0.11, 0.0, 0.0}}}};
}

// One frame after the other, made by hand.
class Handmade : public core::Source {
 public:
  explicit Handmade(std::vector<core::Frame> frames) : frames_(std::move(frames)) {}
  core::SourceInfo info() const override { return {.name = "handmade"}; }
  core::Truth truth() const override { return {}; }
  std::optional<core::Frame> next() override {
    if (num_given_ == frames_.size()) return std::nullopt;
    return frames_[num_given_++];
  }

 private:
  std::vector<core::Frame> frames_;
  std::size_t num_given_ = 0;
};

core::Frame frame_of(const core::Rig& rig, std::vector<cv::Mat> images) {
  core::Frame frame;
  frame.id = core::FrameId(0);
  frame.rig = std::make_shared<const core::Rig>(rig);
  frame.images = std::move(images);
  return frame;
}

core::Frame passed(core::Frame frame) {
  return *rectified(std::make_unique<Handmade>(std::vector{std::move(frame)}))->next();
}

std::vector<cv::Mat> grey_pictures() {
  return {cv::Mat(480, 640, CV_8UC1, cv::Scalar(90)), cv::Mat(480, 640, CV_8UC1, cv::Scalar(70))};
}

std::string refusal(const core::Rig& rig) {
  return complaint([&] { passed(frame_of(rig, grey_pictures())); });
}

// The board before the left camera, tilted.
core::Rigid3 left_from_board() { return {core::exp_so3({0.25, -0.3, 0.1}), {-0.06, -0.05, 0.5}}; }

// A board as each camera of the rig sees it.
std::vector<cv::Mat> pictures_of_board(const core::Rig& rig, const core::Rigid3& body_from_board) {
  std::vector<cv::Mat> images;
  for (std::size_t i = 0; i < 2; ++i) {
    images.push_back(geometry::render_board(std::get<core::PinholeRadtan>(rig.cameras[i]),
                                            inverse(rig.body_from_camera[i]) * body_from_board,
                                            kBoard));
  }
  return images;
}

// Mean absolute difference of brightness on the inner part, which no border of the lens reaches.
double difference(const cv::Mat& a, const cv::Mat& b) {
  const cv::Rect inner(40, 40, a.cols - 80, a.rows - 80);
  return cv::norm(a(inner), b(inner), cv::NORM_L1) / inner.area();
}

TEST(Rectify, ARenderedPairBecomesWhatCamerasInOneRowWouldSee) {
  const core::Rig taken = crooked_rig();
  const core::Rigid3 body_from_board = taken.body_from_camera[0] * left_from_board();
  const core::Frame frame = passed(frame_of(taken, pictures_of_board(taken, body_from_board)));
  EXPECT_TRUE(is_rectified_pair(*frame.rig));
  const double baseline_m =
      (inverse(frame.rig->body_from_camera[0]) * frame.rig->body_from_camera[1]).translation.x();
  EXPECT_NEAR(baseline_m, Eigen::Vector3d(0.11, 0.004, -0.006).norm(), 1e-12);

  core::Rig turned = *frame.rig;  // a twentieth of a degree: 0.4 pixels
  turned.body_from_camera[1].rotation *= core::exp_so3({0.05 / 57.3, 0.0, 0.0});
  const auto expected = pictures_of_board(*frame.rig, body_from_board);
  const auto expected_turned = pictures_of_board(turned, body_from_board);
  for (std::size_t i = 0; i < 2; ++i) {
    const double found = difference(frame.images[i], expected[i]);
    EXPECT_LT(found, 0.5) << "camera " << i << ": levels of 255";
    RecordProperty("difference_" + std::to_string(i), std::to_string(found));
  }
  EXPECT_GT(difference(frame.images[1], expected_turned[1]),
            2.0 * difference(frame.images[1], expected[1]))
      << "a view that is turned a little must not pass for the right one";
}

TEST(Rectify, TheBodyStaysAndCamera0IsRemembered) {
  core::Rig taken = crooked_rig();
  taken.imu = core::Imu{.body_from_imu = {Eigen::Quaterniond::Identity(), {0.0, 0.0, 0.5}}};
  const core::Rig rig = *passed(frame_of(taken, grey_pictures())).rig;
  ASSERT_TRUE(rig.body_from_taken_camera);
  EXPECT_EQ(rig.body_from_told_camera().matrix(), taken.body_from_camera[0].matrix());
  EXPECT_EQ(taken.body_from_told_camera().matrix(), taken.body_from_camera[0].matrix());
  EXPECT_GT(
      core::angle_rad((inverse(taken.body_from_camera[0]) * rig.body_from_camera[0]).rotation),
      0.01);
  EXPECT_EQ(rig.body_from_camera[0].translation, taken.body_from_camera[0].translation);
  EXPECT_EQ(rig.imu.value().body_from_imu.translation.z(), 0.5);
}

TEST(Rectify, DepthFollowsTheFirstCamera) {
  const core::Rig taken = crooked_rig();
  core::Frame frame = frame_of(taken, grey_pictures());
  // a wall of tilted depth, told along the axis of the camera as it was
  const Eigen::Vector3d normal = Eigen::Vector3d(0.2, -0.1, 1.0).normalized();
  frame.depth_m = cv::Mat(480, 640, CV_32FC1);
  const auto depth_on = [&](const Eigen::Vector3d& ray) { return 2.0 / normal.dot(ray) * ray; };
  for (int v = 0; v < 480; ++v) {
    for (int u = 0; u < 640; ++u) {
      frame.depth_m->at<float>(v, u) =
          static_cast<float>(depth_on(geometry::bearing(kLeft, {u, v})).z());
    }
  }
  frame.depth_m->at<float>(240, 320) = 0.0F;
  const core::Frame turned = passed(frame);
  const Eigen::Matrix3d taken_from_turned =
      (inverse(taken.body_from_camera[0]) * turned.rig->body_from_camera[0])
          .rotation.toRotationMatrix();
  EXPECT_GE(cv::countNonZero(*turned.depth_m == 0.0F), 1) << "unknown stays unknown";
  for (int v = 20; v < 480; v += 40) {
    for (int u = 20; u < 640; u += 40) {
      const Eigen::Vector3d ray =
          taken_from_turned * geometry::bearing(turned.rig->cameras[0], {u, v});
      const double expected_m = (taken_from_turned.transpose() * depth_on(ray)).z();
      const double found_m = turned.depth_m->at<float>(v, u);
      EXPECT_TRUE(found_m == 0.0 || std::abs(found_m - expected_m) < 0.002) << u << ", " << v;
    }
  }
}

TEST(Rectify, WhatIsRectifiedOrAloneOrUncalibratedPasses) {
  core::Rig alone = crooked_rig();
  alone.cameras.resize(1);
  alone.body_from_camera.resize(1);
  for (const core::Rig& rig : {straight_rig(), alone, core::Rig{}}) {
    const core::Frame frame = frame_of(rig, grey_pictures());
    const core::Frame after = passed(frame);
    EXPECT_EQ(after.rig, frame.rig);
    EXPECT_EQ(after.images[1].data, frame.images[1].data);
  }
}

TEST(Rectify, PairsThatCannotBeRectifiedAreRefused) {
  core::Rig rig = crooked_rig();
  std::get<core::PinholeRadtan>(rig.cameras[1]).width_px = 320;
  EXPECT_THAT(refusal(rig), HasSubstr("640 x 480 and 320 x 480"));
  rig = crooked_rig();
  rig.body_from_camera[1] = rig.body_from_camera[0];
  EXPECT_THAT(refusal(rig), HasSubstr("0 m apart"));
  rig = straight_rig();
  rig.body_from_camera[1].translation = {0.0, 0.1, 0.0};
  EXPECT_THAT(refusal(rig), HasSubstr("right of the first"));
  rig.body_from_camera[1].translation = {-0.1, 0.0, 0.0};
  EXPECT_THAT(refusal(rig), HasSubstr("right of the first"));
  rig = crooked_rig();
  rig.body_from_camera[1].rotation =
      rig.body_from_camera[0].rotation * core::exp_so3({0.0, 2.0, 0.0});
  EXPECT_THAT(refusal(rig), HasSubstr("expected at most 45"));
  rig = straight_rig();
  rig.body_from_camera[1].translation = {0.01, 0.0, 0.3};  // one before the other
  EXPECT_THAT(refusal(rig), HasSubstr("expected at most 45"));
}

}  // namespace
}  // namespace samewhere::input
