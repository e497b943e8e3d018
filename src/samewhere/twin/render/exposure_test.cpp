#include <cmath>

#include <gtest/gtest.h>

#include <samewhere/twin/render/exposure.hpp>

namespace samewhere::twin {
namespace {

constexpr double kRate_hz = 15.0;

TEST(Exposure, SettlesAfterAStepWithTheLagOfACamera) {
  std::vector<float> means(10, 0.2F);
  means.resize(70, 0.05F);
  const auto exposures = automatic_exposures(means, kRate_hz);
  ASSERT_EQ(exposures.size(), means.size());
  const float before = exposures[9].signal_per_radiance();
  const float after = exposures.back().signal_per_radiance();
  EXPECT_EQ(exposures[0].signal_per_radiance(), before) << "settled from the start";
  EXPECT_NEAR(after / before, 4.0F, 0.01F);
  for (std::size_t i = 10; i < exposures.size(); ++i) {
    EXPECT_GE(exposures[i].signal_per_radiance(), exposures[i - 1].signal_per_radiance());
  }
  // 0.4 s after the step a share of 1 - 1/e is done
  const float done = std::log(exposures[15].signal_per_radiance() / before) / std::log(4.0F);
  EXPECT_NEAR(done, 0.63F, 0.05F);
}

TEST(Exposure, OpensTheShutterFirstAndTurnsUpTheGainThen) {
  const auto bright = automatic_exposures(std::vector<float>{1.0F}, kRate_hz).front();
  const auto usual = automatic_exposures(std::vector<float>{0.2F}, kRate_hz).front();
  const auto dark = automatic_exposures(std::vector<float>{0.03F}, kRate_hz).front();
  EXPECT_LT(bright.duration_s, usual.duration_s);
  EXPECT_LT(usual.duration_s, dark.duration_s);
  EXPECT_FLOAT_EQ(dark.duration_s, 0.010F);
  EXPECT_EQ(bright.gain, 1.0F);
  EXPECT_EQ(usual.gain, 1.0F);
  EXPECT_GT(dark.gain, 3.0F);
}

TEST(Exposure, DarknessLeavesItAsItIs) {
  const auto exposures = automatic_exposures(std::vector<float>{0.2F, 0.0F, 0.0F}, kRate_hz);
  EXPECT_EQ(exposures[2].duration_s, exposures[0].duration_s);
  EXPECT_EQ(exposures[2].gain, exposures[0].gain);
}

}  // namespace
}  // namespace samewhere::twin
