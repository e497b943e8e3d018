#pragma once

#include <cmath>

#include <opencv2/imgproc.hpp>

#include <samewhere/core/rigid3.hpp>
#include <samewhere/geometry/calibration.hpp>
#include <samewhere/geometry/camera.hpp>

namespace samewhere::geometry {

// Brightness of the board's plane in [0, 1]: squares, the outermost half of a square wider than the
// corners tell, on white paper on a grey wall. For tests only.
inline double board_brightness(const Board& board, const Eigen::Vector2d& on_board_m) {
  const Eigen::Vector2d square = on_board_m / board.square_m;
  const auto is_within = [&](double margin) {
    return square.x() > -margin && square.y() > -margin &&
           square.x() < board.num_columns - 1 + margin && square.y() < board.num_rows - 1 + margin;
  };
  if (!is_within(1.6)) return 0.5;
  if (!is_within(1.0)) return 0.9;
  const int parity =
      static_cast<int>(std::floor(square.x())) + static_cast<int>(std::floor(square.y()));
  return parity % 2 == 0 ? 0.1 : 0.9;
}

// What a camera sees of a board, a little out of focus, by the rays of 16 points of each pixel. No
// two of them are in one row or column: edges along the rows are as smooth as others. For tests
// only.
inline cv::Mat render_board(const core::PinholeRadtan& camera,
                            const core::Rigid3& camera_from_board, const Board& board) {
  const core::Rigid3 board_from_camera = inverse(camera_from_board);
  const auto brightness = [&](const Eigen::Vector2d& pixel) {
    const Eigen::Vector3d ray = board_from_camera.rotation * bearing(camera, pixel);
    const double range_m = -board_from_camera.translation.z() / ray.z();
    if (!(range_m > 0.0)) return 0.5;
    return board_brightness(board, (board_from_camera.translation + range_m * ray).head<2>());
  };
  constexpr int kNumSamples = 16;
  cv::Mat image(camera.height_px, camera.width_px, CV_32FC1);
  for (int v = 0; v < image.rows; ++v) {
    for (int u = 0; u < image.cols; ++u) {
      double sum = 0.0;
      for (int i = 0; i < kNumSamples; ++i) {
        sum += brightness({u + (i + 0.5) / kNumSamples - 0.5,
                           v + (i * 7 % kNumSamples + 0.5) / kNumSamples - 0.5});
      }
      image.at<float>(v, u) = static_cast<float>(255.0 / kNumSamples * sum);
    }
  }
  cv::GaussianBlur(image, image, {0, 0}, 0.7);
  cv::Mat bytes;
  image.convertTo(bytes, CV_8U);
  return bytes;
}

}  // namespace samewhere::geometry
