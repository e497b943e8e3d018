#include <cstdint>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/random.hpp>
#include <samewhere/describe/preprocess.hpp>

namespace samewhere::describe {
namespace {

// Grey levels around a random level with a random spread.
cv::Mat noise_image(core::Random& random, int rows, int columns) {
  cv::Mat image(rows, columns, CV_8UC1);
  const double level = random.uniform(0.0, 255.0);
  const double spread = random.uniform(0.0, 80.0);
  for (int i = 0; i < rows * columns; ++i) {
    image.data[i] = cv::saturate_cast<std::uint8_t>(level + spread * random.gaussian());
  }
  return image;
}

double max_difference(const cv::Mat& a, const cv::Mat& b) { return cv::norm(a, b, cv::NORM_INF); }

TEST(Preprocess, GivesAGreyImageOf360RowsAnd480ColumnsFromAnySize) {
  for (const cv::Size size : {cv::Size(1, 1), cv::Size(2, 3), cv::Size(1, 400), cv::Size(640, 480),
                              cv::Size(480, 360), cv::Size(1920, 1080), cv::Size(500, 100)}) {
    for (const int type : {CV_8UC1, CV_8UC3}) {
      const cv::Mat image(size, type, cv::Scalar(40, 80, 120));
      const cv::Mat prepared = preprocess(image, Config{});
      EXPECT_EQ(prepared.rows, 360);
      EXPECT_EQ(prepared.cols, 480);
      EXPECT_EQ(prepared.type(), CV_8UC1);
    }
  }
}

TEST(Preprocess, OfABlackOrConstantOrSinglePixelImageIsUniform) {
  for (const int level : {0, 1, 128, 255}) {
    for (const cv::Size size : {cv::Size(1, 1), cv::Size(64, 48)}) {
      const cv::Mat prepared = preprocess(cv::Mat(size, CV_8UC1, cv::Scalar(level)), Config{});
      EXPECT_EQ(cv::countNonZero(prepared != 255), 0) << "level " << level;
    }
  }
}

TEST(Preprocess, WithoutEqualisationKeepsTheLevels) {
  Config config;
  config.equalize = false;
  const cv::Mat image(48, 64, CV_8UC1, cv::Scalar(77));
  EXPECT_EQ(cv::countNonZero(preprocess(image, config) != 77), 0);
}

TEST(Preprocess, LeavesItsInputAlone) {
  core::Random random(1);
  const cv::Mat image = noise_image(random, 360, 480);
  const cv::Mat before = image.clone();
  preprocess(image, Config{});
  EXPECT_EQ(max_difference(image, before), 0.0);
}

TEST(Preprocess, RefusesWhatIsNoPicture) {
  EXPECT_THROW(preprocess(cv::Mat(), Config{}), core::ContractError);
  EXPECT_THROW(preprocess(cv::Mat(4, 4, CV_32FC1, cv::Scalar(0)), Config{}), core::ContractError);
  EXPECT_THROW(preprocess(cv::Mat(4, 4, CV_8UC4, cv::Scalar(0)), Config{}), core::ContractError);
}

}  // namespace
}  // namespace samewhere::describe
