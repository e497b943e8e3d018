#include <cmath>
#include <cstdint>

#include <opencv2/core.hpp>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/histogram.hpp>

namespace samewhere::core {

std::array<double, 256> cumulative_histogram(const cv::Mat& grey) {
  require(!grey.empty() && grey.type() == CV_8UC1, "a histogram is of 8-bit grey pixels");
  std::array<std::int64_t, 256> num_pixels{};  // h(k) = n_k, eq. (1)
  for (int row = 0; row < grey.rows; ++row) {
    const auto* pixels = grey.ptr<std::uint8_t>(row);
    for (int column = 0; column < grey.cols; ++column) ++num_pixels[pixels[column]];
  }
  // P(k) = n_k / N, eq. (2), and S_k = sum of P(i), i <= k, eq. (3): summed as counts, which is
  // exact, and divided once
  std::array<double, 256> share{};
  std::int64_t num_darker = 0;
  for (std::size_t k = 0; k < share.size(); ++k) {
    num_darker += num_pixels[k];
    share[k] = static_cast<double>(num_darker) / static_cast<double>(grey.total());
  }
  return share;
}

cv::Mat equalize_histogram(const cv::Mat& grey) {
  const std::array<double, 256> share = cumulative_histogram(grey);
  cv::Mat level(1, 256, CV_8UC1);
  for (int k = 0; k < 256; ++k) {
    const double equalized = 255.0 * share[static_cast<std::size_t>(k)];  // E_k = 255 S_k, eq. (4)
    level.at<std::uint8_t>(k) = static_cast<std::uint8_t>(std::lround(equalized));
  }
  cv::Mat equalized;
  cv::LUT(grey, level, equalized);
  return equalized;
}

}  // namespace samewhere::core
