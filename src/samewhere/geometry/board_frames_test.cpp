#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include <samewhere/geometry/board_frames.hpp>

namespace samewhere::geometry {
namespace {

using testing::ElementsAre;

// Squares, seen through a lens that is out of focus by `blur_px`.
cv::Mat squares(double blur_px) {
  cv::Mat image(48, 64, CV_8UC1, cv::Scalar(200));
  for (int x = 0; x < 64; x += 16) cv::rectangle(image, {x, 8, 8, 32}, cv::Scalar(30), cv::FILLED);
  if (blur_px > 0.0) cv::GaussianBlur(image, image, {0, 0}, blur_px);
  return image;
}

TEST(BoardFrames, TheSharpestOfEachStretchIsGiven) {
  SharpestFrames frames(1.0);
  EXPECT_FALSE(frames.add({squares(2.0), "a"}, 10.0));
  EXPECT_FALSE(frames.add({squares(0.0), "b"}, 10.4));
  EXPECT_FALSE(frames.add({squares(1.0), "c"}, 10.9));
  const auto first = frames.add({squares(1.0), "d"}, 11.0);
  ASSERT_TRUE(first);
  EXPECT_EQ(first->name, "b");
  EXPECT_FALSE(frames.add({squares(0.5), "e"}, 11.5));
  ASSERT_TRUE(frames.add({squares(3.0), "f"}, 20.0));
  EXPECT_EQ(frames.finish()->name, "f");
  EXPECT_FALSE(frames.finish());
}

TEST(BoardFrames, ViewsApartAreTakenAndRepetitionsAreNot) {
  const auto at = [](float x) { return std::vector<cv::Point2f>{{x, 0.0F}, {x + 10.0F, 0.0F}}; };
  const std::vector<std::vector<cv::Point2f>> views = {at(0), at(1), at(50), at(51), at(100)};
  EXPECT_THAT(spread_views(views, 10, 5.0), ElementsAre(0, 2, 4));
  EXPECT_THAT(spread_views(views, 2, 5.0), ElementsAre(0, 4));
  EXPECT_THAT(spread_views(views, 10, 0.5), ElementsAre(0, 1, 2, 3, 4));
  EXPECT_THAT(spread_views({}, 10, 5.0), ElementsAre());
}

}  // namespace
}  // namespace samewhere::geometry
