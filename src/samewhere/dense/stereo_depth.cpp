#include <algorithm>
#include <cmath>

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/grey.hpp>
#include <samewhere/core/rectified_pair.hpp>
#include <samewhere/dense/stereo_depth.hpp>
#include <samewhere/geometry/camera.hpp>

namespace samewhere::dense {
namespace {

constexpr int kBlock_px = 5;

// Weights as in OpenCV's description of the matcher; disparities in 16ths of a pixel.
cv::Ptr<cv::StereoSGBM> matcher(int min_disparity_px, int num_disparities_px) {
  constexpr int kArea_px2 = kBlock_px * kBlock_px;
  auto matcher = cv::StereoSGBM::create(min_disparity_px, num_disparities_px, kBlock_px);
  matcher->setP1(8 * kArea_px2);
  matcher->setP2(32 * kArea_px2);
  matcher->setDisp12MaxDiff(1);
  matcher->setUniquenessRatio(10);
  matcher->setSpeckleWindowSize(100);
  matcher->setSpeckleRange(2);
  return matcher;
}

// Where there is anything to match: in black or overexposed parts every disparity fits exactly.
cv::Mat has_structure(const cv::Mat& picture) {
  constexpr int kWindow_px = 15;
  constexpr double kMinMean = 2.0;  // of Sobel's response, that is half a grey level per pixel
  cv::Mat slope;
  cv::Sobel(picture, slope, CV_32F, 1, 0);
  cv::Mat mean;
  cv::boxFilter(cv::abs(slope), mean, CV_32F, {kWindow_px, kWindow_px});
  return mean >= kMinMean;
}

}  // namespace

cv::Mat stereo_depth_m(const core::Rig& rig, const cv::Mat& left, const cv::Mat& right,
                       const Config& config) {
  const auto baseline_m = core::rectified_baseline_m(rig);
  if (!baseline_m) {
    throw core::InputError("expected a rectified pair of pictures: " + baseline_m.error());
  }
  const core::PinholeRadtan& camera = geometry::pinhole(rig.cameras[0]);
  const double px_m = camera.fx_px * *baseline_m;
  const auto lowest_px = static_cast<int>(std::floor(px_m / config.max_depth_m));
  const double width_px = px_m / config.min_depth_m - lowest_px;
  const int num_steps = std::clamp(static_cast<int>(std::ceil(width_px / 16.0)), 1,
                                   std::max(camera.width_px / 32, 1));
  const cv::Mat left_grey = core::as_grey(left);
  cv::Mat disparity_16ths;
  matcher(lowest_px, 16 * num_steps)->compute(left_grey, core::as_grey(right), disparity_16ths);
  cv::Mat depth_m(left.size(), CV_32F, cv::Scalar(0.0));
  for (int row = 0; row < depth_m.rows; ++row) {
    for (int column = 0; column < depth_m.cols; ++column) {
      const int found = disparity_16ths.at<std::int16_t>(row, column);
      const double parallax_px = found / 16.0;
      const bool is_known = found >= 16 * lowest_px && parallax_px > 0.0;
      if (is_known) depth_m.at<float>(row, column) = static_cast<float>(px_m / parallax_px);
    }
  }
  depth_m.setTo(0.0, ~has_structure(left_grey));
  return depth_m;
}

std::optional<cv::Mat> depth_of(const core::Frame& frame, const Config& config) {
  if (frame.depth_m) return frame.depth_m;
  if (frame.images.size() < 2 || frame.rig->cameras.size() < 2) return std::nullopt;
  return stereo_depth_m(*frame.rig, frame.images[0], frame.images[1], config);
}

}  // namespace samewhere::dense
