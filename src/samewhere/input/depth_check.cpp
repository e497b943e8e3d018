#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include <samewhere/input/depth_check.hpp>

namespace samewhere::input {
namespace {

// Depth cameras see nothing nearer than 0.4 m, and even on a desk a tenth of the picture is beyond
// 0.8 m.
constexpr float kNearMedian_m = 0.4F;
constexpr float kNearBackground_m = 0.8F;
constexpr float kFarMedian_m = 10.0F;

void add_known(const cv::Mat& depth_m, std::vector<float>& known) {
  constexpr int kStep_px = 4;
  for (int y = 0; y < depth_m.rows; y += kStep_px) {
    for (int x = 0; x < depth_m.cols; x += kStep_px) {
      if (const float d = depth_m.at<float>(y, x); d > 0.0F) known.push_back(d);
    }
  }
}

std::vector<float> known_depths_m(std::span<const cv::Mat> depths_m) {
  std::vector<float> known;
  for (const cv::Mat& depth_m : depths_m) add_known(depth_m, known);
  std::sort(known.begin(), known.end());
  return known;
}

}  // namespace

std::optional<std::string> doubt_about_depth(std::span<const cv::Mat> depths_m,
                                             double units_per_m) {
  constexpr std::size_t kMinPixels = 100;
  constexpr double kMillimetres = 1000.0;
  const std::vector<float> known = known_depths_m(depths_m);
  if (known.size() < kMinPixels) return std::nullopt;
  const float median_m = known[known.size() / 2];
  const float background_m = known[known.size() * 9 / 10];
  const bool is_near = median_m < kNearMedian_m || background_m < kNearBackground_m;
  if (!is_near && median_m <= kFarMedian_m) return std::nullopt;
  std::string text = fmt::format(
      "half of the depth is below {:.2f} m, nine tenths below {:.2f} m, at {} units per metre; "
      "depth cameras measure 0.4 to 10 m",
      median_m, background_m, units_per_m);
  if (is_near && units_per_m > kMillimetres)
    return text + "; does it count millimetres (--set input.depth_factor=1000)?";
  if (!is_near && units_per_m <= kMillimetres)
    return text + "; does it count 5000 a metre (--set input.depth_factor=5000)?";
  return text + "; is that factor right (--set input.depth_factor=N)?";
}

}  // namespace samewhere::input
