#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <opencv2/core/mat.hpp>
#include <opencv2/core/types.hpp>

#include <samewhere/core/rig.hpp>

namespace samewhere::geometry {

// A flat checkerboard, told by its inner corners: where four squares meet.
struct Board {
  int num_columns = 0;  // of inner corners, at least 3
  int num_rows = 0;     // at least 3
  double square_m = 0.0;

  int num_corners() const { return num_columns * num_rows; }
};

// The inner corners in the board's plane z = 0, row by row, metres.
std::vector<cv::Point3f> corners_in_board(const Board& board);

// Where a picture (8-bit grey or BGR) shows them, in the same order or from the other end,
// sub-pixel (Duda and Frese 2018, as in OpenCV). Nothing if the whole board is not found.
std::optional<std::vector<cv::Point2f>> find_board(const cv::Mat& image, const Board& board);

struct Calibration {
  core::PinholeRadtan camera;         // k3 stays 0: boards hardly reach where it would show
  double rmse_px = 0.0;               // reprojection error of all corners of the views used
  std::vector<double> view_rmse_px;   // of each view's, used or not
  std::vector<std::size_t> left_out;  // views that do not belong to this camera, by position
  double focal_sd_ratio = 0.0;        // standard deviation of fx or fy, the larger share of it
};

// The camera that saw the board in all views, each the corners of one picture of `size_px`: Zhang's
// method (2000), refined with k1 k2 p1 p2. A view whose error is several times that of the others
// (taken at another zoom, of a bent board) is left out, if two thirds of them agree.
// Throws InputError for fewer than 3 views; if the boards
// of all views are nearly parallel, for then no focal length is wrong; if fx and fy are not known
// to 3 % (standard deviation); and if the field of view is that of no such lens (camera.hpp).
Calibration calibrate(const Board& board, const std::vector<std::vector<cv::Point2f>>& views,
                      const cv::Size& size_px);

}  // namespace samewhere::geometry
