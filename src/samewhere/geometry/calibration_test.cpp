#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/random.hpp>
#include <samewhere/geometry/calibration.hpp>
#include <samewhere/geometry/test_board.hpp>

namespace samewhere::geometry {
namespace {

using testing::HasSubstr;

constexpr Board kBoard{.num_columns = 9, .num_rows = 6, .square_m = 0.025};
constexpr core::PinholeRadtan kCamera{.width_px = 640,
                                      .height_px = 480,
                                      .fx_px = 512.0,
                                      .fy_px = 509.0,
                                      .cx_px = 327.3,
                                      .cy_px = 233.9,
                                      .k1 = -0.21,
                                      .k2 = 0.06,
                                      .p1 = 0.0007,
                                      .p2 = -0.0004};

// The board's middle `range_m` before the camera, moved aside and turned.
core::Rigid3 camera_from_board(const Eigen::Vector3d& turn_rad, const Eigen::Vector3d& middle_m) {
  const core::Rigid3 middle_from_board{Eigen::Quaterniond::Identity(),
                                       {-4.0 * kBoard.square_m, -2.5 * kBoard.square_m, 0.0}};
  return core::Rigid3{core::exp_so3(turn_rad), middle_m} * middle_from_board;
}

std::vector<core::Rigid3> tilted_views() {
  return {camera_from_board({0.0, 0.0, 0.0}, {0.0, 0.0, 0.24}),
          camera_from_board({0.5, 0.0, 0.05}, {0.05, -0.03, 0.30}),
          camera_from_board({-0.5, 0.1, 0.0}, {-0.06, 0.02, 0.30}),
          camera_from_board({0.1, 0.55, 0.0}, {0.05, 0.03, 0.30}),
          camera_from_board({0.0, -0.55, 0.1}, {-0.05, -0.03, 0.30}),
          camera_from_board({0.4, 0.4, 0.2}, {-0.07, 0.05, 0.33}),
          camera_from_board({-0.4, -0.4, -0.2}, {0.08, -0.05, 0.33}),
          camera_from_board({0.3, -0.4, 0.6}, {0.09, 0.06, 0.36}),
          camera_from_board({-0.35, 0.4, -0.5}, {-0.09, -0.06, 0.36})};
}

// What a perfect detector would find.
std::vector<cv::Point2f> projected(const core::Rigid3& camera_from_this_board,
                                   const core::PinholeRadtan& camera = kCamera) {
  std::vector<cv::Point2f> pixels;
  for (const cv::Point3f& corner : corners_in_board(kBoard)) {
    const auto pixel =
        project(camera, camera_from_this_board * Eigen::Vector3d(corner.x, corner.y, corner.z));
    pixels.emplace_back(static_cast<float>(pixel.value().x()),
                        static_cast<float>(pixel.value().y()));
  }
  return pixels;
}

// What a detector would find that errs by `noise_px` (standard deviation) along rows and columns.
std::vector<cv::Point2f> measured(const core::Rigid3& camera_from_this_board, double noise_px,
                                  core::Random& random) {
  std::vector<cv::Point2f> pixels = projected(camera_from_this_board);
  for (cv::Point2f& pixel : pixels) {
    pixel.x += static_cast<float>(noise_px * random.gaussian());
    pixel.y += static_cast<float>(noise_px * random.gaussian());
  }
  return pixels;
}

std::string refusal(const std::vector<std::vector<cv::Point2f>>& views) {
  try {
    calibrate(kBoard, views, {kCamera.width_px, kCamera.height_px});
  } catch (const core::InputError& error) {
    return error.what();
  }
  return "none";
}

TEST(Calibration, RenderedBoardsGiveTheCameraThatSawThem) {
  std::vector<std::vector<cv::Point2f>> views;
  double worst_px = 0.0;
  for (const core::Rigid3& pose : tilted_views()) {
    const cv::Mat image = render_board(kCamera, pose, kBoard);
    const auto corners = find_board(image, kBoard);
    ASSERT_TRUE(corners) << "view " << views.size();
    ASSERT_EQ(corners->size(), 54U);
    // the order may begin at the other end
    std::vector<cv::Point2f> truth = projected(pose);
    if (cv::norm(truth.front() - corners->front()) > 5.0) std::reverse(truth.begin(), truth.end());
    for (std::size_t i = 0; i < truth.size(); ++i) {
      worst_px = std::max(worst_px, cv::norm(truth[i] - (*corners)[i]));
    }
    views.push_back(*corners);
  }
  EXPECT_LT(worst_px, 0.2);
  const Calibration found = calibrate(kBoard, views, {640, 480});
  EXPECT_NEAR(found.camera.fx_px, kCamera.fx_px, 0.003 * kCamera.fx_px);
  EXPECT_NEAR(found.camera.fy_px, kCamera.fy_px, 0.003 * kCamera.fy_px);
  EXPECT_NEAR(found.camera.cx_px, kCamera.cx_px, 1.0);
  EXPECT_NEAR(found.camera.cy_px, kCamera.cy_px, 1.0);
  EXPECT_NEAR(found.camera.k1, kCamera.k1, 0.01);
  EXPECT_EQ(found.camera.width_px, 640);
  EXPECT_EQ(found.camera.k3, 0.0);
  EXPECT_LT(found.rmse_px, 0.1);
  EXPECT_EQ(found.view_rmse_px.size(), views.size());
  RecordProperty("worst_corner_px", std::to_string(worst_px));
  RecordProperty("rmse_px", std::to_string(found.rmse_px));
}

TEST(Calibration, TheErrorOfEachViewIsItsOwn) {
  std::vector<std::vector<cv::Point2f>> views;
  for (const core::Rigid3& pose : tilted_views()) views.push_back(projected(pose));
  core::Random random(1);
  for (cv::Point2f& corner : views[4]) {
    corner +=
        cv::Point2f(static_cast<float>(random.gaussian()), static_cast<float>(random.gaussian()));
  }
  const Calibration found = calibrate(kBoard, views, {640, 480});
  EXPECT_EQ(std::max_element(found.view_rmse_px.begin(), found.view_rmse_px.end()) -
                found.view_rmse_px.begin(),
            4);
  EXPECT_NEAR(found.view_rmse_px[4], std::sqrt(2.0), 0.3);
}

// Of the same size, by a camera of another zoom.
TEST(Calibration, ViewsOfAnotherCameraAreLeftOut) {
  for (const double zoom : {0.8, 1.1, 1.4}) {
    for (const std::vector<std::size_t>& odd : {std::vector<std::size_t>{5}, {2, 7}}) {
      core::PinholeRadtan other = kCamera;
      other.fx_px *= zoom;
      other.fy_px *= zoom;
      core::Random random(3);
      std::vector<std::vector<cv::Point2f>> views;
      for (const core::Rigid3& pose : tilted_views()) views.push_back(measured(pose, 0.1, random));
      for (const std::size_t view : odd) views[view] = projected(tilted_views()[view], other);
      const Calibration found = calibrate(kBoard, views, {640, 480});
      EXPECT_EQ(found.left_out, odd) << zoom;
      EXPECT_NEAR(found.camera.fx_px, kCamera.fx_px, 0.005 * kCamera.fx_px) << zoom;
      for (const std::size_t view : odd) EXPECT_GT(found.view_rmse_px[view], 0.3) << zoom;
      EXPECT_LT(found.rmse_px, 0.2) << zoom;
    }
  }
}

TEST(Calibration, SoundViewsAreAllUsed) {
  for (const double noise_px : {0.05, 0.3, 1.0}) {
    core::Random random(4);
    std::vector<std::vector<cv::Point2f>> views;
    for (const core::Rigid3& pose : tilted_views())
      views.push_back(measured(pose, noise_px, random));
    EXPECT_THAT(calibrate(kBoard, views, {640, 480}).left_out, testing::IsEmpty()) << noise_px;
  }
}

TEST(Calibration, FewerThanThreeViewsAreRefused) {
  const auto poses = tilted_views();
  EXPECT_THAT(
      refusal({projected(poses[0]), projected(poses[1])}),
      testing::AllOf(HasSubstr("9 x 6 inner corners in 2 pictures"), HasSubstr("at least 3")));
  EXPECT_EQ(refusal({projected(poses[0]), projected(poses[1]), projected(poses[3])}), "none");
}

TEST(Calibration, ParallelBoardsAreRefusedHoweverMany) {
  std::vector<std::vector<cv::Point2f>> facing;
  std::vector<std::vector<cv::Point2f>> tilted;
  for (int i = 0; i < 6; ++i) {
    const Eigen::Vector3d middle_m(0.02 * i - 0.05, 0.01 * i - 0.02, 0.3 + 0.03 * i);
    facing.push_back(projected(camera_from_board({0.0, 0.0, 0.2 * i}, middle_m)));
    tilted.push_back(projected(camera_from_board({0.4, 0.2, 0.0}, middle_m)));
  }
  EXPECT_THAT(refusal(facing), HasSubstr("expected at least 10"));
  EXPECT_THAT(refusal(tilted), HasSubstr("expected at least 10"));
  EXPECT_THAT(refusal({facing[0], facing[0], facing[0]}), HasSubstr("expected at least 10"));
}

// Noise alone makes boards that face the camera look tilted, by 4 to 80 degrees: what the fit says
// of its own tilt is no sign of sound views.
TEST(Calibration, BoardsThatFaceTheCameraAreRefusedWhateverTheNoise) {
  for (int seed = 0; seed < 10; ++seed) {
    for (const double noise_px : {0.05, 0.3, 1.0}) {
      core::Random random(static_cast<std::uint64_t>(seed));
      std::vector<std::vector<cv::Point2f>> views;
      for (int i = 0; i < 12; ++i) {
        const Eigen::Vector3d middle_m(random.uniform(-0.06, 0.06), random.uniform(-0.05, 0.05),
                                       random.uniform(0.3, 0.5));
        views.push_back(measured(camera_from_board({0.0, 0.0, random.uniform(-0.3, 0.3)}, middle_m),
                                 noise_px, random));
      }
      EXPECT_THAT(refusal(views), testing::AnyOf(HasSubstr("expected to 3 % or better"),
                                                 HasSubstr("expected at least 10")))
          << "seed " << seed << ", noise " << noise_px;
    }
  }
}

TEST(Calibration, TiltedBoardsPassWithAWideMarginAndTheirErrorIsForetold) {
  double sum_squares = 0.0;
  double sum_foretold = 0.0;
  for (int seed = 0; seed < 20; ++seed) {
    core::Random random(static_cast<std::uint64_t>(seed));
    std::vector<std::vector<cv::Point2f>> views;
    for (const core::Rigid3& pose : tilted_views()) views.push_back(measured(pose, 0.3, random));
    const Calibration found = calibrate(kBoard, views, {640, 480});
    EXPECT_LT(found.focal_sd_ratio, 0.01) << "seed " << seed;
    const double error_ratio = found.camera.fx_px / kCamera.fx_px - 1.0;
    sum_squares += error_ratio * error_ratio;
    sum_foretold += found.focal_sd_ratio * found.focal_sd_ratio;
  }
  EXPECT_GT(sum_squares, 0.4 * sum_foretold);
  EXPECT_LT(sum_squares, 2.0 * sum_foretold);
}

TEST(Calibration, AFieldOfViewThatNoSuchLensHasIsRefused) {
  core::PinholeRadtan telescope = kCamera;
  telescope.fx_px *= 10.0;
  telescope.fy_px *= 10.0;
  std::vector<std::vector<cv::Point2f>> views;
  for (core::Rigid3 pose : tilted_views()) {
    pose.translation.z() += 10.0 * 0.3;
    views.push_back(projected(pose, telescope));
  }
  EXPECT_THAT(refusal(views),
              testing::AllOf(HasSubstr("field of view of 7."), HasSubstr("expected 10 to 150")));
}

TEST(Calibration, APictureWithoutTheBoardHasNoCorners) {
  EXPECT_FALSE(find_board(cv::Mat(480, 640, CV_8UC1, cv::Scalar(90)), kBoard));
  const cv::Mat image = render_board(kCamera, tilted_views().front(), kBoard);
  EXPECT_FALSE(find_board(image, {.num_columns = 12, .num_rows = 9, .square_m = 0.025}));
  cv::Mat covered = image.clone();
  covered(cv::Rect(0, 0, 320, 480)).setTo(90);
  EXPECT_FALSE(find_board(covered, kBoard));
}

}  // namespace
}  // namespace samewhere::geometry
