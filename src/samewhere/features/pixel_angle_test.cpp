#include <gtest/gtest.h>

#include <samewhere/features/pixel_angle.hpp>

namespace samewhere::features {
namespace {

TEST(PixelWidthRatio, IsOneForUsualAndLargePictures) {
  EXPECT_EQ(pixel_width_ratio({640, 480}), 1.0);
  EXPECT_EQ(pixel_width_ratio({540, 360}), 1.0);
  EXPECT_EQ(pixel_width_ratio({1280, 960}), 1.0);
}

TEST(PixelWidthRatio, GrowsAsThePictureShrinks) {
  EXPECT_DOUBLE_EQ(pixel_width_ratio({320, 240}), 2.0);
  EXPECT_DOUBLE_EQ(pixel_width_ratio({160, 120}), 4.0);
}

}  // namespace
}  // namespace samewhere::features
