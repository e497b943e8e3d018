#include <opencv2/imgproc.hpp>

#include <samewhere/core/grey.hpp>
#include <samewhere/core/histogram.hpp>
#include <samewhere/features/preprocess.hpp>

namespace samewhere::features {
namespace {

constexpr int kMedianSide_px = 3;

cv::Mat without_noise(const cv::Mat& grey) {
  cv::Mat quiet;
  cv::medianBlur(grey, quiet, kMedianSide_px);
  return quiet;
}

}  // namespace

cv::Mat preprocess(const cv::Mat& image, const Config& config) {
  const cv::Mat grey = core::as_grey(image);
  const cv::Mat quiet = config.denoise ? without_noise(grey) : grey;
  return config.equalize ? core::equalize_histogram(quiet) : quiet;
}

}  // namespace samewhere::features
