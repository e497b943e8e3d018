#include <array>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <samewhere/input/depth_check.hpp>

namespace samewhere::input {
namespace {

using testing::HasSubstr;

// A floor and walls from 0.6 to 4 m, read with another factor than it was written with.
std::string doubt(double written, double read) {
  cv::Mat depth_m(120, 160, CV_32FC1);
  for (int y = 0; y < depth_m.rows; ++y)
    for (int x = 0; x < depth_m.cols; ++x)
      depth_m.at<float>(y, x) = static_cast<float>((0.6 + 3.4 * y / 119.0) * written / read);
  return doubt_about_depth({&depth_m, 1}, read).value_or("none");
}

TEST(DepthCheck, ARoomReadAsItWasWrittenRaisesNoWarning) {
  EXPECT_EQ(doubt(1000.0, 1000.0), "none");
  EXPECT_EQ(doubt(5000.0, 5000.0), "none");
}

TEST(DepthCheck, MillimetresReadAt5000AMetreAreWarnedOf) {
  EXPECT_THAT(doubt(1000.0, 5000.0), HasSubstr("input.depth_factor=1000"));
}

TEST(DepthCheck, AFactorOf5000ReadAsMillimetresIsWarnedOf) {
  EXPECT_THAT(doubt(5000.0, 1000.0), HasSubstr("input.depth_factor=5000"));
}

TEST(DepthCheck, OneNearOrFarPictureAmongOthersRaisesNoWarning) {
  const cv::Mat near(120, 160, CV_32FC1, cv::Scalar(0.3));
  const cv::Mat far(120, 160, CV_32FC1, cv::Scalar(14.0));
  const cv::Mat room(120, 160, CV_32FC1, cv::Scalar(2.0));
  EXPECT_TRUE(doubt_about_depth({&near, 1}, 5000.0));
  const std::array pictures = {near, room, room, far, room};
  EXPECT_FALSE(doubt_about_depth(pictures, 5000.0));
}

TEST(DepthCheck, APictureWithoutDepthTellsNothing) {
  const std::array pictures = {cv::Mat(120, 160, CV_32FC1, cv::Scalar(0)), cv::Mat()};
  EXPECT_FALSE(doubt_about_depth(pictures, 5000.0));
}

}  // namespace
}  // namespace samewhere::input
