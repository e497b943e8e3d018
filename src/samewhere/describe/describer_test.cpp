#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/random.hpp>
#include <samewhere/core/similarity.hpp>
#include <samewhere/describe/describer.hpp>

namespace samewhere::describe {
namespace {

constexpr core::FrameId kAnyFrame(7);

// A room of random tilted things, seen from a step to the side by shifting `shift_px`.
cv::Mat room(std::uint64_t seed, int shift_px = 0) {
  core::Random random(seed);
  cv::Mat image(480, 640, CV_8UC3, cv::Scalar(120, 120, 120));
  const auto drawn = [&](int bound) {
    return static_cast<int>(random.index(static_cast<std::uint64_t>(bound)));
  };
  for (int i = 0; i < 40; ++i) {
    const cv::Point centre(drawn(640) + shift_px, drawn(480));
    const cv::Size half_axes(10 + drawn(120), 5 + drawn(20));
    cv::ellipse(image, centre, half_axes, drawn(180), 0.0, 360.0,
                cv::Scalar(drawn(256), drawn(256), drawn(256)), cv::FILLED);
  }
  return image;
}

double similarity(const cv::Mat& a, const cv::Mat& b) {
  const auto describer = make_describer(Config{});
  return core::ncc(describer->describe(kAnyFrame, a).unit, describer->describe(kAnyFrame, b).unit);
}

TEST(Describer, AViewBecomesAUnitVectorOfTheAnnouncedDescriber) {
  const auto describer = make_describer(Config{});
  const core::Descriptor descriptor = describer->describe(kAnyFrame, room(1));
  EXPECT_EQ(descriptor.frame, kAnyFrame);
  EXPECT_EQ(descriptor.describer_checksum, describer->checksum());
  EXPECT_EQ(descriptor.unit.size(), 1260U);
  EXPECT_NEAR(core::dot(descriptor.unit, descriptor.unit), 1.0, 1e-5);
  EXPECT_EQ(describer->describe(kAnyFrame, room(1)).unit, descriptor.unit);
}

TEST(Describer, AViewWithoutStructureIsAllZero) {
  const auto describer = make_describer(Config{});
  for (const cv::Mat& image :
       {cv::Mat(480, 640, CV_8UC3, cv::Scalar(0, 0, 0)), cv::Mat(1, 1, CV_8UC1, cv::Scalar(9)),
        cv::Mat(3, 2, CV_8UC1, cv::Scalar(255))}) {
    EXPECT_THAT(describer->describe(kAnyFrame, image).unit, testing::Each(0.0F));
  }
  EXPECT_THROW(describer->describe(kAnyFrame, cv::Mat()), core::ContractError);
}

TEST(Describer, AStepAsideLooksMoreAlikeThanAnotherRoom) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const double step_aside = similarity(room(seed), room(seed, 25));
    const double other_room = similarity(room(seed), room(seed + 100));
    EXPECT_GT(step_aside, other_room + 0.1) << "seed " << seed;
  }
}

TEST(Describer, ChangedLightHardlyChangesTheView) {
  cv::Mat darker;
  room(3).convertTo(darker, -1, 0.5, 10.0);
  EXPECT_GT(similarity(room(3), darker), 0.99);
}

TEST(Describer, EverySettingChangesTheChecksum) {
  std::set<std::uint64_t> checksums{make_describer(Config{})->checksum()};
  EXPECT_EQ(checksums.count(make_describer(Config{})->checksum()), 1U);
  for (const char* setting : {"width_px=640", "height_px=480", "equalize=false", "hog.width_px=200",
                              "hog.height_px=160", "hog.cell_px=40", "hog.weak_gradient=0"}) {
    Config config;
    core::set_config(config, setting);
    EXPECT_TRUE(checksums.insert(make_describer(config)->checksum()).second) << setting;
  }
}

TEST(Describer, SettingsThatDoNotFitAreNamed) {
  Config config;
  config.hog.width_px = 150;
  try {
    make_describer(config);
    FAIL() << "accepted a width of 150 px in cells of 20 px";
  } catch (const core::InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("describe.hog.width_px = 150"));
  }
  config = Config{};
  config.hog.height_px = 20;
  EXPECT_THROW(make_describer(config), core::InputError);
}

}  // namespace
}  // namespace samewhere::describe
