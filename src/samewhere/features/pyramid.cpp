#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include <samewhere/features/pyramid.hpp>

namespace samewhere::features {
namespace {

constexpr int kMinSide_px = 64;  // a smaller level has hardly any room between its borders

Eigen::Array2f size_of(const cv::Mat& image) {
  return {static_cast<float>(image.cols), static_cast<float>(image.rows)};
}

}  // namespace

std::vector<cv::Mat> pyramid(const cv::Mat& grey, const Config& config) {
  std::vector<cv::Mat> levels;
  for (int i = 0; i < config.num_levels; ++i) {
    const double scale = std::pow(config.scale_factor, -i);
    const cv::Size size_px(static_cast<int>(std::lround(grey.cols * scale)),
                           static_cast<int>(std::lround(grey.rows * scale)));
    if (std::min(size_px.width, size_px.height) < kMinSide_px) break;
    cv::Mat level = grey;
    if (i > 0) cv::resize(levels.back(), level, size_px, 0, 0, cv::INTER_LINEAR);
    levels.push_back(level);
  }
  return levels;
}

std::vector<double> level_scales(const Config& config) {
  std::vector<double> scales;
  for (int i = 0; i < config.num_levels; ++i) scales.push_back(std::pow(config.scale_factor, i));
  return scales;
}

Eigen::Vector2f full_from_level(const Eigen::Vector2f& level_px, const cv::Mat& level,
                                const cv::Mat& full) {
  return (level_px.array() + 0.5F) * size_of(full) / size_of(level) - 0.5F;
}

Eigen::Vector2f level_from_full(const Eigen::Vector2f& full_px, const cv::Mat& level,
                                const cv::Mat& full) {
  return (full_px.array() + 0.5F) * size_of(level) / size_of(full) - 0.5F;
}

}  // namespace samewhere::features
