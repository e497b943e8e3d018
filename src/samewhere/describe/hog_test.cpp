#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <numeric>
#include <string>

#include <gtest/gtest.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/random.hpp>
#include <samewhere/describe/hog.hpp>

namespace samewhere::describe {
namespace {

constexpr std::ptrdiff_t kBlockLength =
    std::ptrdiff_t{kHogCellsPerBlock} * kHogCellsPerBlock * kHogNumBins;

cv::Mat random_image(core::Random& random, int rows, int columns, int max_level = 255) {
  cv::Mat image(rows, columns, CV_8UC1);
  for (int i = 0; i < rows * columns; ++i) {
    image.data[i] =
        static_cast<std::uint8_t>(random.index(static_cast<std::uint64_t>(max_level) + 1));
  }
  return image;
}

// Level = a x + b y + 128: one gradient everywhere but at the border.
cv::Mat ramp(int side, double a, double b) {
  cv::Mat image(side, side, CV_8UC1);
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      image.at<std::uint8_t>(y, x) = cv::saturate_cast<std::uint8_t>(128.0 + a * x + b * y);
    }
  }
  return image;
}

double distance(const std::vector<float>& x, const std::vector<float>& y) {
  double largest = x.size() == y.size() ? 0.0 : 1e9;
  for (std::size_t i = 0; i < std::min(x.size(), y.size()); ++i) {
    largest = std::max(largest, std::abs(static_cast<double>(x[i]) - y[i]));
  }
  return largest;
}

double length(const std::vector<float>& x) {
  return std::sqrt(std::inner_product(x.begin(), x.end(), x.begin(), 0.0));
}

double level(const cv::Mat& image, int x, int y) {
  return image.at<std::uint8_t>(std::clamp(y, 0, image.rows - 1), std::clamp(x, 0, image.cols - 1));
}

// Share of a vote `distance` bins or cells away from a centre.
double tent(double distance) { return std::max(0.0, 1.0 - std::abs(distance)); }

// The slow way: what all pixels of the image say about one bin of one cell.
double bin_of_cell(const cv::Mat& image, int cell_px, int cell_x, int cell_y, int bin) {
  double sum = 0.0;
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      const double dx = level(image, x + 1, y) - level(image, x - 1, y);
      const double dy = level(image, x, y + 1) - level(image, x, y - 1);
      double turn = std::atan2(dy, dx) / std::numbers::pi;  // 1 is half a turn
      if (turn < 0.0) turn += 1.0;
      const double bins_away = std::remainder(turn * kHogNumBins - (bin + 0.5), kHogNumBins);
      sum += std::hypot(dx, dy) * tent(bins_away) * tent((x + 0.5) / cell_px - (cell_x + 0.5)) *
             tent((y + 0.5) / cell_px - (cell_y + 0.5));
    }
  }
  return sum;
}

void normalize(std::vector<double>& block) {
  const double squared = std::inner_product(block.begin(), block.end(), block.begin(), 0.0);
  for (double& value : block) value /= std::sqrt(squared);
}

std::vector<float> slow_hog(const cv::Mat& image, int cell_px) {
  std::vector<float> blocks;
  for (int row = 0; row + 1 < image.rows / cell_px; ++row) {
    for (int column = 0; column + 1 < image.cols / cell_px; ++column) {
      std::vector<double> block;
      for (int i = 0; i < static_cast<int>(kBlockLength); ++i) {
        const int cell = i / kHogNumBins;
        block.push_back(
            bin_of_cell(image, cell_px, column + cell % 2, row + cell / 2, i % kHogNumBins));
      }
      normalize(block);
      for (double& value : block) value = std::min(value, 0.2);
      normalize(block);
      blocks.insert(blocks.end(), block.begin(), block.end());
    }
  }
  return blocks;
}

TEST(Hog, EqualsTheSlowFormulation) {
  for (int seed = 0; seed < 12; ++seed) {
    core::Random random(static_cast<std::uint64_t>(seed));
    const int cell_px = 1 + static_cast<int>(random.index(7));
    const int rows = cell_px * (2 + static_cast<int>(random.index(3)));
    const int columns = cell_px * (2 + static_cast<int>(random.index(3)));
    const cv::Mat image = random_image(random, rows, columns);
    EXPECT_LT(distance(hog(image, cell_px, 0.0), slow_hog(image, cell_px)), 1e-4)
        << "seed " << seed;
  }
}

TEST(Hog, PutsEachOrientationIntoItsBin) {
  const auto strongest_bins = [](double a, double b) {
    const std::vector<float> blocks = hog(ramp(32, a, b), 8, 0.0);
    // the block in the middle is free of border pixels; its first cell
    const auto* cell = blocks.data() + 4 * kBlockLength;
    std::vector<int> order(kHogNumBins);
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [&](int i, int j) { return cell[i] > cell[j]; });
    std::sort(order.begin(), order.begin() + 2);
    return std::pair(order[0], order[1]);
  };
  EXPECT_EQ(strongest_bins(3.0, 0.0), std::pair(0, 8));   // 0 degrees, between 170 and 10
  EXPECT_EQ(strongest_bins(2.0, 2.0), std::pair(1, 2));   // 45 degrees, between 30 and 50
  EXPECT_EQ(strongest_bins(2.0, -2.0), std::pair(6, 7));  // 135 degrees, between 130 and 150
}

TEST(Hog, ASoleOrientationAtABinCentreFillsThatBinOnly) {
  const std::vector<float> blocks = hog(ramp(32, 0.0, 3.0), 8, 0.0);  // 90 degrees: bin 4
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    EXPECT_NEAR(blocks[i], i % kHogNumBins == 4 ? 0.5 : 0.0, 0.02) << i;
  }
}

TEST(Hog, IgnoresBrightnessContrastAndTheSignOfEdges) {
  for (int seed = 0; seed < 20; ++seed) {
    core::Random random(static_cast<std::uint64_t>(seed));
    const cv::Mat image = random_image(random, 24, 32, 60);
    const std::vector<float> plain = hog(image, 8, 0.0);
    EXPECT_LT(distance(hog(image + 100, 8, 0.0), plain), 1e-5) << "seed " << seed;
    EXPECT_LT(distance(hog(image * 4, 8, 0.0), plain), 1e-5) << "seed " << seed;
    EXPECT_LT(distance(hog(255 - image, 8, 0.0), plain), 1e-5) << "seed " << seed;
  }
}

TEST(Hog, WeakBlocksFadeAndStrongOnesStay) {
  core::Random random(4);
  const cv::Mat strong = random_image(random, 16, 16);
  const cv::Mat weak = strong / 64;
  EXPECT_NEAR(length(hog(strong, 8, 0.0)), 1.0, 1e-5);
  EXPECT_NEAR(length(hog(weak, 8, 0.0)), 1.0, 1e-5);
  EXPECT_GT(length(hog(strong, 8, 32.0)), 0.9);
  EXPECT_LT(length(hog(weak, 8, 32.0)), 0.1);
  EXPECT_EQ(length(hog(cv::Mat(16, 16, CV_8UC1, cv::Scalar(9)), 8, 32.0)), 0.0);
  EXPECT_EQ(length(hog(cv::Mat(16, 16, CV_8UC1, cv::Scalar(9)), 8, 0.0)), 0.0);
}

TEST(Hog, ABlockOfExactlyTheWeakGradientCountsForSevenTenths) {
  // a gradient in all directions alike and of one strength cannot be drawn exactly: random pixels
  // of the mean magnitude come near
  core::Random random(7);
  constexpr int kSide = 128;
  const cv::Mat image = random_image(random, kSide, kSide);
  double sum = 0.0;
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      sum += std::hypot(level(image, x + 1, y) - level(image, x - 1, y),
                        level(image, x, y + 1) - level(image, x, y - 1));
    }
  }
  const std::vector<float> blocks = hog(image, kSide / 4, sum / (kSide * kSide));
  const auto middle = blocks.begin() + 4 * kBlockLength;  // loses no votes beyond the border
  EXPECT_NEAR(length({middle, middle + kBlockLength}), std::sqrt(0.5), 0.02);
}

TEST(Hog, HasTheAnnouncedLengthAndNothingNegative) {
  core::Random random(2);
  const std::vector<float> blocks = hog(random_image(random, 120, 160), 20, 32.0);
  EXPECT_EQ(blocks.size(), 1260U);  // 7 x 5 blocks of 36
  EXPECT_EQ(hog_length(cv::Size(160, 120), 20), 1260);
  EXPECT_GE(*std::min_element(blocks.begin(), blocks.end()), 0.0F);
}

TEST(Hog, RefusesImagesThatAreNotWholeCells) {
  EXPECT_THROW(hog(cv::Mat(16, 17, CV_8UC1, cv::Scalar(0)), 8, 0.0), core::ContractError);
  EXPECT_THROW(hog(cv::Mat(8, 16, CV_8UC1, cv::Scalar(0)), 8, 0.0), core::ContractError);
  EXPECT_THROW(hog(cv::Mat(16, 16, CV_8UC3, cv::Scalar(0)), 8, 0.0), core::ContractError);
  EXPECT_THROW(hog(cv::Mat(), 8, 0.0), core::ContractError);
}

}  // namespace
}  // namespace samewhere::describe
