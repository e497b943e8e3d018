#include <opencv2/imgproc.hpp>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/grey.hpp>
#include <samewhere/core/histogram.hpp>
#include <samewhere/describe/preprocess.hpp>

namespace samewhere::describe {

cv::Mat preprocess(const cv::Mat& image, const Config& config) {
  core::require(!image.empty(), "a view to describe has pixels");
  core::require(image.type() == CV_8UC1 || image.type() == CV_8UC3,
                "a view to describe is 8-bit grey or BGR");
  const cv::Mat grey = core::as_grey(image);
  const cv::Size size(config.width_px, config.height_px);
  // averaging over the area keeps a shrunk image free of aliasing, but does not enlarge smoothly
  const bool is_shrunk = size.width <= grey.cols && size.height <= grey.rows;
  cv::Mat resized;
  cv::resize(grey, resized, size, 0.0, 0.0, is_shrunk ? cv::INTER_AREA : cv::INTER_LINEAR);
  return config.equalize ? core::equalize_histogram(resized) : resized;
}

}  // namespace samewhere::describe
