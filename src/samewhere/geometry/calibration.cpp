#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/grey.hpp>
#include <samewhere/geometry/calibration.hpp>

namespace samewhere::geometry {
namespace {

using core::InputError;

constexpr double kDegrees_per_rad = 180.0 / std::numbers::pi;

[[noreturn]] void fail_alike(double largest_rad) {
  throw InputError(
      fmt::format("calibration: the board is turned by {:.1f} degrees at most from picture to "
                  "picture, expected "
                  "at least 10: tilt it differently before the camera",
                  largest_rad * kDegrees_per_rad));
}

// The largest angle between the planes of two boards. Turning within the plane tells nothing.
double largest_tilt_rad(const std::vector<cv::Mat>& turns) {
  std::vector<cv::Vec3d> normals;
  for (const cv::Mat& turn : turns) {
    cv::Matx33d camera_from_board;
    cv::Rodrigues(turn, camera_from_board);
    normals.emplace_back(camera_from_board.col(2).val);
  }
  double min_cosine = 1.0;
  for (const cv::Vec3d& a : normals) {
    for (const cv::Vec3d& b : normals) min_cosine = std::min(min_cosine, std::abs(a.dot(b)));
  }
  return std::acos(std::min(min_cosine, 1.0));
}

// As much around a corner as shows no other one.
int half_window_px(const Board& board, const std::vector<cv::Point2f>& corners) {
  double nearest_px = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < corners.size(); ++i) {
    if (i % static_cast<std::size_t>(board.num_columns) == 0) continue;  // from row to row
    nearest_px = std::min(nearest_px, cv::norm(corners[i] - corners[i - 1]));
  }
  constexpr double kShare = 0.35;
  return static_cast<int>(std::clamp(kShare * nearest_px, 2.0, 8.0));
}

core::PinholeRadtan camera_of(const cv::Matx33d& k, const cv::Mat& distortion,
                              const cv::Size& size_px) {
  return {.width_px = size_px.width,
          .height_px = size_px.height,
          .fx_px = k(0, 0),
          .fy_px = k(1, 1),
          .cx_px = k(0, 2),
          .cy_px = k(1, 2),
          .k1 = distortion.at<double>(0),
          .k2 = distortion.at<double>(1),
          .p1 = distortion.at<double>(2),
          .p2 = distortion.at<double>(3)};
}

}  // namespace

std::vector<cv::Point3f> corners_in_board(const Board& board) {
  std::vector<cv::Point3f> corners;
  for (int row = 0; row < board.num_rows; ++row) {
    for (int column = 0; column < board.num_columns; ++column) {
      corners.emplace_back(static_cast<float>(column * board.square_m),
                           static_cast<float>(row * board.square_m), 0.0F);
    }
  }
  return corners;
}

std::optional<std::vector<cv::Point2f>> find_board(const cv::Mat& image, const Board& board) {
  const cv::Mat grey = core::as_grey(image);
  std::vector<cv::Point2f> corners;
  if (!cv::findChessboardCornersSB(grey, {board.num_columns, board.num_rows}, corners,
                                   cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_EXHAUSTIVE)) {
    return std::nullopt;
  }
  const int half_px = half_window_px(board, corners);
  const cv::TermCriteria until(cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 50, 1e-3);
  cv::cornerSubPix(grey, corners, {half_px, half_px}, {-1, -1}, until);
  return corners;
}

Calibration calibrate(const Board& board, const std::vector<std::vector<cv::Point2f>>& views,
                      const cv::Size& size_px) {
  constexpr std::size_t kMinViews = 3;
  constexpr double kMinTilt_rad = 10.0 / kDegrees_per_rad;
  if (views.size() < kMinViews) {
    throw InputError(
        fmt::format("calibration: found the board of {} x {} inner corners in {} pictures, "
                    "expected at least {}",
                    board.num_columns, board.num_rows, views.size(), kMinViews));
  }
  const std::vector<std::vector<cv::Point3f>> boards(views.size(), corners_in_board(board));
  cv::Matx33d k = cv::Matx33d::eye();
  cv::Mat distortion;
  std::vector<cv::Mat> turns;
  std::vector<cv::Mat> shifts;
  cv::Mat view_rmse_px;
  Calibration found;
  try {
    found.rmse_px =
        cv::calibrateCamera(boards, views, size_px, k, distortion, turns, shifts, cv::noArray(),
                            cv::noArray(), view_rmse_px, cv::CALIB_FIX_K3);
  } catch (const cv::Exception&) {
    fail_alike(0.0);  // equations that determine nothing
  }
  const double tilt_rad = largest_tilt_rad(turns);
  if (!std::isfinite(found.rmse_px) || !(tilt_rad >= kMinTilt_rad)) fail_alike(tilt_rad);
  found.camera = camera_of(k, distortion, size_px);
  found.view_rmse_px.assign(view_rmse_px.begin<double>(), view_rmse_px.end<double>());
  return found;
}

}  // namespace samewhere::geometry
