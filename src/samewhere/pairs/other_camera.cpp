#include <algorithm>
#include <cmath>
#include <cstdint>

#include <opencv2/imgproc.hpp>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/grey.hpp>
#include <samewhere/pairs/other_camera.hpp>

namespace samewhere::pairs {
namespace {

constexpr double kMinSize = 0.45;  // of the sides: what is finer is lost
constexpr double kMaxBlur_px = 1.2;
constexpr double kMaxLogGamma = 0.4;
constexpr double kMaxLogGain = 0.3;
constexpr double kLightSigma = 0.25;  // of the logarithm, from place to place
constexpr double kMaxNoiseSigma = 0.04;

// Brighter in one part, darker in another, smoothly.
cv::Mat light(const cv::Size& size_px, core::Random& random) {
  cv::Mat coarse(4, 5, CV_32F);
  for (int i = 0; i < 20; ++i)
    coarse.at<float>(i / 5, i % 5) = static_cast<float>(std::exp(kLightSigma * random.gaussian()));
  cv::Mat fine;
  cv::resize(coarse, fine, size_px, 0.0, 0.0, cv::INTER_LINEAR);
  return fine;
}

cv::Mat noise(const cv::Size& size_px, double sigma, core::Random& random) {
  cv::Mat noise(size_px, CV_32F);
  for (int row = 0; row < noise.rows; ++row) {
    for (int column = 0; column < noise.cols; ++column)
      noise.at<float>(row, column) = static_cast<float>(sigma * random.gaussian());
  }
  return noise;
}

}  // namespace

cv::Mat by_another_camera(const cv::Mat& image, core::Random& random) {
  core::require(image.depth() == CV_8U && !image.empty(), "a picture to change has 8 bits");
  const double size = random.uniform(kMinSize, 1.0);
  const double blur_px = random.uniform(0.0, kMaxBlur_px);
  const double gamma = std::exp(random.uniform(-kMaxLogGamma, kMaxLogGamma));
  const double gain = std::exp(random.uniform(-kMaxLogGain, kMaxLogGain));
  const double sigma = random.uniform(0.0, kMaxNoiseSigma);
  cv::Mat small;
  cv::resize(core::as_grey(image), small, {}, size, size, cv::INTER_AREA);
  small.convertTo(small, CV_32F, 1.0 / 255.0);
  if (blur_px > 0.3) cv::GaussianBlur(small, small, {}, blur_px);
  cv::pow(small, gamma, small);
  small = gain * small.mul(light(small.size(), random)) + noise(small.size(), sigma, random);
  cv::Mat seen;
  small.convertTo(small, CV_8U, 255.0);
  cv::resize(small, seen, image.size(), 0.0, 0.0, cv::INTER_LINEAR);
  return seen;
}

}  // namespace samewhere::pairs
