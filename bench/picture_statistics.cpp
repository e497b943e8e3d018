#include "picture_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>

#include "orb_matches.hpp"
#include <samewhere/core/errors.hpp>
#include <samewhere/core/grey.hpp>

namespace samewhere::bench {
namespace {

constexpr int kMinSide_px = 64;
constexpr int kFastThreshold = 20;
constexpr int kGridColumns = 16;
constexpr int kGridRows = 12;
constexpr int kMaxOrb = 5000;
constexpr int kBlock_px = 16;
constexpr double kFlatGradient = 2.0;

double percentile(std::vector<float> values, double ratio) {
  if (values.empty()) return 0.0;
  const auto index = static_cast<std::ptrdiff_t>(ratio * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + index, values.end());
  return static_cast<double>(values[static_cast<std::size_t>(index)]);
}

double share_of(const cv::Mat& mask) {
  return static_cast<double>(cv::countNonZero(mask)) / static_cast<double>(mask.total());
}

void add_corners(const cv::Mat& grey, PictureStatistics& statistics) {
  std::vector<cv::KeyPoint> corners;
  cv::FAST(grey, corners, kFastThreshold, true);
  std::vector<bool> is_hit(kGridColumns * kGridRows, false);
  for (const cv::KeyPoint& corner : corners) {
    const int column = static_cast<int>(corner.pt.x) * kGridColumns / grey.cols;
    const int row = static_cast<int>(corner.pt.y) * kGridRows / grey.rows;
    is_hit[static_cast<std::size_t>(row * kGridColumns + column)] = true;
  }
  statistics.num_fast_corners = static_cast<double>(corners.size());
  statistics.fast_spread_ratio =
      static_cast<double>(std::count(is_hit.begin(), is_hit.end(), true)) /
      static_cast<double>(is_hit.size());
  statistics.num_orb_features = extract_orb(grey, kMaxOrb).size();
}

void add_tones(const cv::Mat& grey, PictureStatistics& statistics) {
  cv::Scalar mean;
  cv::Scalar deviation;
  cv::meanStdDev(grey, mean, deviation);
  statistics.mean_grey = mean[0];
  statistics.contrast_grey = deviation[0];
  statistics.dark_ratio = share_of(grey <= 15);
  statistics.bright_ratio = share_of(grey >= 240);
}

void add_gradients(const cv::Mat& grey, PictureStatistics& statistics) {
  cv::Mat along_x;
  cv::Mat along_y;
  cv::Sobel(grey, along_x, CV_32F, 1, 0, 3, 1.0 / 8.0);
  cv::Sobel(grey, along_y, CV_32F, 0, 1, 3, 1.0 / 8.0);
  cv::Mat magnitude;
  cv::magnitude(along_x, along_y, magnitude);
  const std::vector<float> values(magnitude.begin<float>(), magnitude.end<float>());
  statistics.median_gradient = percentile(values, 0.5);
  statistics.strong_gradient = percentile(values, 0.99);
  statistics.flat_ratio = share_of(magnitude < kFlatGradient);
}

double fine_contrast(const cv::Mat& grey) {
  cv::Mat values;
  grey.convertTo(values, CV_32F);
  cv::Mat smooth;
  cv::GaussianBlur(values, smooth, cv::Size(), 1.0);
  cv::Scalar mean;
  cv::Scalar deviation;
  cv::meanStdDev(values - smooth, mean, deviation);
  return deviation[0];
}

double colour_saturation(const cv::Mat& image) {
  if (image.channels() != 3) return 0.0;
  cv::Mat hsv;
  cv::cvtColor(image, hsv, cv::COLOR_BGR2HSV);
  return cv::mean(hsv)[1] / 255.0;
}

// Power at each frequency of the largest power-of-two square in the middle, with the zero frequency
// in the corner.
cv::Mat power_spectrum(const cv::Mat& grey) {
  int side = 1;
  while (2 * side <= std::min(grey.cols, grey.rows)) side *= 2;
  const cv::Rect middle((grey.cols - side) / 2, (grey.rows - side) / 2, side, side);
  cv::Mat square;
  grey(middle).convertTo(square, CV_32F);
  square -= cv::mean(square);
  cv::Mat window;
  cv::createHanningWindow(window, square.size(), CV_32F);
  cv::Mat spectrum;
  cv::dft(square.mul(window), spectrum, cv::DFT_COMPLEX_OUTPUT);
  std::array<cv::Mat, 2> parts;
  cv::split(spectrum, parts.data());
  return parts[0].mul(parts[0]) + parts[1].mul(parts[1]);
}

// Mean power of the rings between whole numbers of waves per side.
std::vector<double> ring_means(const cv::Mat& power) {
  const int half = power.cols / 2;
  std::vector<double> sums(static_cast<std::size_t>(half) + 1, 0.0);
  std::vector<int> counts(sums.size(), 0);
  for (int y = 0; y < power.rows; ++y) {
    for (int x = 0; x < power.cols; ++x) {
      const double waves = std::hypot(std::min(x, power.cols - x), std::min(y, power.rows - y));
      const auto ring = static_cast<std::size_t>(std::lround(waves));
      if (ring >= sums.size()) continue;
      sums[ring] += power.at<float>(y, x);
      ++counts[ring];
    }
  }
  for (std::size_t ring = 0; ring < sums.size(); ++ring) sums[ring] /= std::max(1, counts[ring]);
  return sums;
}

// Slope of the straight line through points, least squares.
double line_slope(const std::vector<cv::Point2d>& points) {
  cv::Point2d mean;
  for (const cv::Point2d& point : points) mean += point / static_cast<double>(points.size());
  double xx = 0.0;
  double xy = 0.0;
  for (const cv::Point2d& point : points) {
    xx += (point.x - mean.x) * (point.x - mean.x);
    xy += (point.x - mean.x) * (point.y - mean.y);
  }
  return xx > 0.0 ? xy / xx : 0.0;
}

}  // namespace

double noise_level(const cv::Mat& grey) {
  const cv::Mat mask = (cv::Mat_<float>(3, 3) << 1, -2, 1, -2, 4, -2, 1, -2, 1);
  cv::Mat answer;
  cv::filter2D(grey, answer, CV_32F, mask);
  answer = cv::abs(answer);
  std::vector<float> levels;
  for (int y = 0; y + kBlock_px <= grey.rows; y += kBlock_px) {
    for (int x = 0; x + kBlock_px <= grey.cols; x += kBlock_px) {
      const cv::Rect block(x, y, kBlock_px, kBlock_px);
      const double mean_grey = cv::mean(grey(block))[0];
      if (mean_grey < 16.0 || mean_grey > 239.0) continue;
      levels.push_back(static_cast<float>(cv::mean(answer(block))[0]));
    }
  }
  // mean |x| of a normal x is sqrt(2 / pi) of its deviation; the mask's weights add up to 6^2
  return std::sqrt(std::numbers::pi / 2.0) / 6.0 * percentile(levels, 0.1);
}

double spectrum_slope(const cv::Mat& grey, double min_frequency, double max_frequency) {
  const cv::Mat power = power_spectrum(grey);
  const std::vector<double> rings = ring_means(power);
  std::vector<cv::Point2d> points;
  for (std::size_t ring = 1; ring < rings.size(); ++ring) {
    const double frequency = static_cast<double>(ring) / power.cols;
    if (frequency < min_frequency || frequency > max_frequency || rings[ring] <= 0.0) continue;
    points.emplace_back(std::log(frequency), std::log(rings[ring]));
  }
  return points.empty() ? 0.0 : -line_slope(points);
}

PictureStatistics picture_statistics(const cv::Mat& image) {
  core::require(std::min(image.cols, image.rows) >= kMinSide_px,
                "a picture to be measured has at least 64 pixels a side");
  const cv::Mat grey = core::as_grey(image);
  PictureStatistics statistics;
  add_corners(grey, statistics);
  add_tones(grey, statistics);
  add_gradients(grey, statistics);
  statistics.noise_grey = noise_level(grey);
  statistics.coarse_slope = spectrum_slope(grey, 1.0 / 64.0, 1.0 / 8.0);
  statistics.fine_slope = spectrum_slope(grey, 1.0 / 8.0, 1.0 / 3.0);
  statistics.fine_contrast_grey = fine_contrast(grey);
  statistics.colour_saturation = colour_saturation(image);
  return statistics;
}

}  // namespace samewhere::bench
