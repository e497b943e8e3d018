#include <algorithm>
#include <limits>
#include <utility>

#include <opencv2/imgproc.hpp>

#include <samewhere/core/grey.hpp>
#include <samewhere/geometry/board_frames.hpp>

namespace samewhere::geometry {
namespace {

double mean_distance_px(const std::vector<cv::Point2f>& a, const std::vector<cv::Point2f>& b) {
  double sum_px = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum_px += cv::norm(a[i] - b[i]);
  return sum_px / static_cast<double>(a.size());
}

}  // namespace

double sharpness(const cv::Mat& image) {
  cv::Mat edges;
  cv::Laplacian(core::as_grey(image), edges, CV_32F);
  cv::Scalar mean;
  cv::Scalar deviation;
  cv::meanStdDev(edges, mean, deviation);
  return deviation[0] * deviation[0];
}

std::optional<SharpestFrames::Frame> SharpestFrames::add(Frame frame, double stamp_s) {
  std::optional<Frame> ended;
  if (best_ && stamp_s >= begin_s_ + stretch_s_) ended = finish();
  if (!best_) begin_s_ = stamp_s;
  const double this_sharpness = sharpness(frame.image);
  if (!best_ || this_sharpness > best_sharpness_) {
    best_ = std::move(frame);
    best_sharpness_ = this_sharpness;
  }
  return ended;
}

std::optional<SharpestFrames::Frame> SharpestFrames::finish() {
  return std::exchange(best_, std::nullopt);
}

std::vector<std::size_t> spread_views(const std::vector<std::vector<cv::Point2f>>& views,
                                      std::size_t max_views, double min_distance_px) {
  if (views.empty()) return {};
  std::vector<std::size_t> taken = {0};
  std::vector<double> distances_px(views.size(), std::numeric_limits<double>::infinity());
  while (taken.size() < max_views) {
    for (std::size_t i = 0; i < views.size(); ++i) {
      distances_px[i] = std::min(distances_px[i], mean_distance_px(views[i], views[taken.back()]));
    }
    const auto farthest = std::max_element(distances_px.begin(), distances_px.end());
    if (*farthest < min_distance_px) break;
    taken.push_back(static_cast<std::size_t>(farthest - distances_px.begin()));
  }
  std::sort(taken.begin(), taken.end());
  return taken;
}

}  // namespace samewhere::geometry
