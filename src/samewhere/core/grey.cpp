#include <opencv2/imgproc.hpp>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/grey.hpp>

namespace samewhere::core {

cv::Mat as_grey(const cv::Mat& image) {
  if (image.channels() == 1) return image;
  require(image.channels() == 3, "a picture is grey or has blue, green and red");
  cv::Mat grey;
  cv::cvtColor(image, grey, cv::COLOR_BGR2GRAY);
  return grey;
}

}  // namespace samewhere::core
