#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include <samewhere/features/corners.hpp>
#include <samewhere/features/describe.hpp>
#include <samewhere/features/hamming.hpp>
#include <samewhere/features/match_pair.hpp>
#include <samewhere/features/pyramid.hpp>

namespace samewhere::features {
namespace {

TEST(Pyramid, APixelIsWhereItWasBeforeAndAfterResizing) {
  cv::Mat image(480, 640, CV_8U, cv::Scalar(0));
  cv::circle(image, {203, 151}, 12, cv::Scalar(255), -1);
  const std::vector<cv::Mat> levels = pyramid(image, {});
  ASSERT_EQ(levels.size(), 8U);
  for (const cv::Mat& level : levels) {
    const cv::Moments moments = cv::moments(level);
    const Eigen::Vector2f centre(static_cast<float>(moments.m10 / moments.m00),
                                 static_cast<float>(moments.m01 / moments.m00));
    const Eigen::Vector2f in_full = full_from_level(centre, level, image);
    EXPECT_NEAR(in_full.x(), 203.0F, 0.2F);
    EXPECT_NEAR(in_full.y(), 151.0F, 0.2F);
    EXPECT_LT((level_from_full(in_full, level, image) - centre).norm(), 1e-3F);
  }
}

TEST(Pyramid, LevelsThatAreTooSmallAreLeftOut) {
  EXPECT_TRUE(pyramid(cv::Mat(63, 640, CV_8U, cv::Scalar(0)), {}).empty());
  EXPECT_EQ(pyramid(cv::Mat(80, 640, CV_8U, cv::Scalar(0)), {}).size(), 2U);
}

// A square drawn large, moved by parts of a pixel, and made smaller.
TEST(Corners, MoveByPartsOfAPixel) {
  const auto corner_x = [](int shift_eighths, bool is_fine) {
    cv::Mat large(800, 800, CV_8U, cv::Scalar(40));
    cv::rectangle(large, cv::Rect(400 + shift_eighths, 400, 200, 200), cv::Scalar(200), -1);
    cv::Mat image;
    cv::resize(large, image, {100, 100}, 0, 0, cv::INTER_AREA);
    cv::GaussianBlur(image, image, {}, 1.0);
    std::vector<Corner> found = find_corners(image, 0, {});
    EXPECT_FALSE(found.empty());
    double left_x = 100.0;
    for (const Corner& corner : found) {
      const Corner placed = is_fine ? with_subpixel(image, corner) : corner;
      left_x = std::min(left_x, static_cast<double>(placed.level_px.x()));
    }
    return left_x;
  };
  const auto mean_squared_error = [&](bool is_fine) {
    double sum = 0.0;
    for (int eighths = 0; eighths < 8; ++eighths) {
      const double moved_px = corner_x(eighths, is_fine) - corner_x(0, is_fine);
      sum += std::pow(moved_px - eighths / 8.0, 2) / 8.0;
    }
    return sum;
  };
  EXPECT_LT(mean_squared_error(true), 0.8 * mean_squared_error(false));
}

TEST(SpreadEvenly, TwoOfEachCellFirstThenThoseOfEachLevelInTurn) {
  const Config config{.num_features = 6, .num_levels = 2, .scale_factor = 2.0, .cell_px = 40};
  // one cell is crowded, on two levels; another holds two weak corners
  std::vector<Corner> corners;
  for (int i = 0; i < 5; ++i)
    corners.push_back({{5.0F + static_cast<float>(i), 5.0F}, 0, 100.0F - static_cast<float>(i)});
  corners.push_back({{3.0F, 3.0F}, 1, 90.0F});  // of the same part of the picture
  corners.push_back({{100.0F, 5.0F}, 0, 2.0F});
  corners.push_back({{105.0F, 5.0F}, 0, 1.0F});
  const auto strength = [](const Corner& corner) { return corner.strength; };
  std::vector<float> kept;
  for (const Corner& corner : spread_evenly(corners, config)) kept.push_back(strength(corner));
  EXPECT_EQ(kept, (std::vector<float>{100.0F, 2.0F, 99.0F, 1.0F, 90.0F, 98.0F}));
  std::reverse(corners.begin(), corners.end());
  std::vector<float> reversed;
  for (const Corner& corner : spread_evenly(corners, config)) reversed.push_back(strength(corner));
  EXPECT_EQ(reversed, kept) << "whatever order they come in";
}

TEST(Describe, TurnsWithThePicture) {
  cv::Mat image(101, 101, CV_8U);
  cv::RNG random(7);
  random.fill(image, cv::RNG::UNIFORM, 0, 256);
  cv::GaussianBlur(image, image, {}, 2.5);
  cv::Mat turned;
  cv::rotate(image, turned, cv::ROTATE_90_CLOCKWISE);
  const Eigen::Vector2f centre(50, 50);
  const float angle_rad = orientation_rad(image, centre);
  const float turned_angle_rad = orientation_rad(turned, centre);
  EXPECT_NEAR(std::cos(turned_angle_rad), -std::sin(angle_rad), 1e-5);
  EXPECT_NEAR(std::sin(turned_angle_rad), std::cos(angle_rad), 1e-5);

  std::array<std::uint8_t, kDescriptorBytes> first{};
  std::array<std::uint8_t, kDescriptorBytes> second{};
  describe(blurred_for_descriptors(image), centre, angle_rad, first.data());
  describe(blurred_for_descriptors(turned), centre, turned_angle_rad, second.data());
  EXPECT_LE(distance_bits(first.data(), second.data()), 8);
}

}  // namespace
}  // namespace samewhere::features
