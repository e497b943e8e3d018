#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <samewhere/geometry/camera.hpp>
#include <samewhere/input/guess_camera.hpp>
#include <samewhere/input/test_recording.hpp>

namespace samewhere::input {
namespace {

using testing::HasSubstr;

double view_deg(const core::PinholeRadtan& camera) {
  return geometry::horizontal_field_of_view_rad(camera) * 180.0 / 3.14159265358979;
}

TEST(GuessCamera, ByTheSizeAloneTheLongerSideIsSeenUnder62Degrees) {
  const GuessedCamera guess = guess_camera({640, 480}, 0.0, {});
  EXPECT_NEAR(view_deg(guess.camera), kGuessedView_deg, 1e-9);
  EXPECT_EQ(guess.camera.cx_px, 319.5);
  EXPECT_EQ(guess.camera.k1, 0.0);
  EXPECT_EQ(guess_camera({480, 640}, 0.0, {}).camera.fx_px, guess.camera.fx_px);
  EXPECT_THAT(guess.reason, HasSubstr("62 degrees"));
}

TEST(GuessCamera, WhatIsGivenGoesFirst) {
  EXPECT_NEAR(view_deg(guess_camera({640, 480}, 90.0, 28.0).camera), 90.0, 1e-9);
  // 36 mm are as long as the focal length of film shows under 53.1 degrees
  const GuessedCamera guess = guess_camera({3600, 2400}, 0.0, 36.0);
  EXPECT_NEAR(guess.camera.fx_px, 3600.0, 1.0);
  EXPECT_THAT(guess.reason, HasSubstr("EXIF"));
}

TEST_F(Open, PicturesWithoutCalibrationGetTheCameraThatIsGiven) {
  write_image("1.jpg");
  write_image("2.jpg");
  Peeked peeked = peek(open());
  ASSERT_TRUE(peeked.first);
  const core::PinholeRadtan camera = guess_camera(peeked.first->images[0].size(), 0.0, {}).camera;
  const auto source = with_camera(std::move(peeked.source), camera);
  EXPECT_TRUE(source->info().is_calibrated);
  for (int i = 0; i < 2; ++i) {
    const auto frame = source->next();
    ASSERT_TRUE(frame);
    EXPECT_EQ(geometry::pinhole(frame->rig->cameras.at(0)).fx_px, camera.fx_px);
  }
  EXPECT_FALSE(source->next());
}

}  // namespace
}  // namespace samewhere::input
