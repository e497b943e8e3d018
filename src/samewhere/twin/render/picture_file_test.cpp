#include <limits>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include <samewhere/twin/front/test_source.hpp>
#include <samewhere/twin/render/picture_file.hpp>

namespace samewhere::twin {
namespace {

bool is_same(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && a.type() == b.type() && cv::norm(a, b, cv::NORM_INF) == 0.0;
}

// Every value that a depth picture can hold.
cv::Mat all_units() {
  cv::Mat units(256, 256, CV_16UC1);
  for (int i = 0; i < 65536; ++i) units.at<std::uint16_t>(i / 256, i % 256) = i & 0xffff;
  return units;
}

TEST(PictureFile, PicturesComeBackAsTheyAre) {
  core::Random random(1);
  const cv::Mat colour = TestSource::random_picture(random);
  cv::Mat grey;
  cv::extractChannel(colour, grey, 1);
  for (const cv::Mat& picture : {colour, grey, all_units()}) {
    const auto back = picture_of_png(png_bytes(picture));
    ASSERT_TRUE(back);
    EXPECT_TRUE(is_same(*back, picture)) << "type " << picture.type();
  }
}

TEST(PictureFile, DamageIsNoticed) {
  core::Random random(2);
  const cv::Mat picture = TestSource::random_picture(random);
  const std::string good = png_bytes(picture);
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    core::Random damage(seed);
    std::string bytes = good;
    char& byte = bytes[damage.index(bytes.size())];
    byte = static_cast<char>(byte ^ static_cast<char>(1 + damage.index(255)));
    if (seed % 2 == 1) bytes = good.substr(0, damage.index(good.size()));
    const auto back = picture_of_png(bytes);
    // what stands behind the pixels may be lost without harm
    EXPECT_TRUE(!back || is_same(*back, picture)) << "seed " << seed;
  }
  EXPECT_FALSE(picture_of_png(""));
  EXPECT_FALSE(picture_of_png(good.substr(0, good.size() / 2)));
}

TEST(PictureFile, DepthInUnitsComesBackExactly) {
  cv::Mat units = all_units();
  units.at<std::uint16_t>(255, 255) = 0;  // 65535 is no depth
  EXPECT_TRUE(is_same(depth_units(depth_of_units(units)), units));
}

TEST(PictureFile, WhatIsNoDepthIsUnknown) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  const cv::Mat depth_m = (cv::Mat_<float>(1, 6) << nan, infinity, -1.0F, 0.0F, 13.1071F, 13.1068F);
  const cv::Mat units = depth_units(depth_m);
  for (int x = 0; x < 5; ++x) EXPECT_EQ(units.at<std::uint16_t>(0, x), 0) << x;
  EXPECT_EQ(units.at<std::uint16_t>(0, 5), 65534);
}

}  // namespace
}  // namespace samewhere::twin
