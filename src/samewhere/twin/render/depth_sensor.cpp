#include <algorithm>
#include <cmath>

#include <samewhere/twin/building/noise.hpp>
#include <samewhere/twin/render/depth_sensor.hpp>
#include <samewhere/twin/render/texture.hpp>

namespace samewhere::twin {
namespace {

constexpr float kMinRange_m = 0.3F;
constexpr float kMaxRange_m = 8.0F;
constexpr float kNoise_per_m = 0.0015F;       // standard deviation over depth squared
constexpr float kFocalBaseline_px_m = 43.0F;  // disparity times depth
constexpr float kDisparityStep_px = 0.125F;
constexpr float kSteps_per_m = 5000.0F;  // of the number that the sensor gives out
constexpr float kGrazing = 0.2F;         // cosine below which measurements begin to fail
constexpr float kBlind = 0.05F;          // and where all do

// Inverse depth is linear on a plane: where it bends, surfaces meet or cover each other.
float bend(const cv::Mat& depth_m, const cv::Point& at, const cv::Point& step) {
  const cv::Rect all(0, 0, depth_m.cols, depth_m.rows);
  if (!all.contains(at - step) || !all.contains(at + step)) return 0.0F;
  const float here_m = depth_m.at<float>(at);
  return std::abs(here_m / depth_m.at<float>(at - step) + here_m / depth_m.at<float>(at + step) -
                  2.0F);
}

bool is_beside_edge(const cv::Mat& depth_m, const cv::Point& at) {
  constexpr float kMinBend = 0.03F;
  return bend(depth_m, at, {2, 0}) > kMinBend || bend(depth_m, at, {0, 2}) > kMinBend;
}

float chance_of_hole(const View& view, const cv::Point& at) {
  constexpr float kAnywhere = 0.002F;
  constexpr float kBesideEdge = 0.6F;
  const float incidence = view.incidence.at<float>(at);
  const float grazing = (kGrazing - incidence) / (kGrazing - kBlind);
  const float edge = is_beside_edge(view.depth_m, at) ? kBesideEdge : 0.0F;
  return std::max({kAnywhere, grazing, edge});
}

float with_noise(float depth_m, std::uint32_t bits) {
  const float noisy_m = depth_m + kNoise_per_m * depth_m * depth_m * nearly_gaussian(bits);
  const float disparity_steps = std::round(kFocalBaseline_px_m / (noisy_m * kDisparityStep_px));
  const float measured_m = kFocalBaseline_px_m / (disparity_steps * kDisparityStep_px);
  return std::round(measured_m * kSteps_per_m) / kSteps_per_m;
}

}  // namespace

cv::Mat measure_depth(const View& view, const Building& building, std::uint64_t seed) {
  const int num_at_rest = static_cast<int>(building.rectangles.size());
  cv::Mat measured_m = cv::Mat::zeros(view.depth_m.size(), CV_32F);
  for (int y = 0; y < measured_m.rows; ++y) {
    for (int x = 0; x < measured_m.cols; ++x) {
      const float depth_m = view.depth_m.at<float>(y, x);
      const int surface = view.surface.at<int>(y, x);
      if (surface < 0 || depth_m < kMinRange_m || depth_m > kMaxRange_m) continue;
      // what moves does not shine
      if (surface < num_at_rest &&
          is_emitting(building.rectangles[static_cast<std::size_t>(surface)].material)) {
        continue;
      }
      const auto pixel = static_cast<std::uint64_t>(y * measured_m.cols + x);
      const std::uint64_t bits = scramble(seed + pixel);
      if (unit_float(static_cast<std::uint32_t>(bits)) < chance_of_hole(view, {x, y})) continue;
      measured_m.at<float>(y, x) = with_noise(depth_m, static_cast<std::uint32_t>(bits >> 32));
    }
  }
  return measured_m;
}

}  // namespace samewhere::twin
