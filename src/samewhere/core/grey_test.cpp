#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/grey.hpp>

namespace samewhere::core {
namespace {

std::uint8_t grey_of(const cv::Scalar& bgr) {
  return as_grey(cv::Mat(4, 5, CV_8UC3, bgr)).at<std::uint8_t>(3, 4);
}

TEST(Grey, BlueGreenAndRedCountAsTheEyeSeesThem) {
  EXPECT_EQ(grey_of({255, 0, 0}), 29);  // 0.114 * 255
  EXPECT_EQ(grey_of({0, 255, 0}), 150);
  EXPECT_EQ(grey_of({0, 0, 255}), 76);
  EXPECT_EQ(grey_of({90, 90, 90}), 90);
}

TEST(Grey, AGreyPictureIsNotCopied) {
  const cv::Mat grey(4, 5, CV_8UC1, cv::Scalar(7));
  EXPECT_EQ(as_grey(grey).data, grey.data);
}

TEST(Grey, OtherChannelsAreRefused) {
  EXPECT_THROW(as_grey(cv::Mat(4, 5, CV_8UC4, cv::Scalar::all(1))), ContractError);
}

}  // namespace
}  // namespace samewhere::core
