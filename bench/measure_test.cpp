#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "impostor_rule.hpp"
#include "orb_matches.hpp"
#include "picture_statistics.hpp"
#include "tower.hpp"
#include "view_pairs.hpp"
#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/core/random.hpp>

namespace samewhere::bench {
namespace {

cv::Mat grey_noise(cv::Size size_px, double mean, double deviation, std::uint64_t seed) {
  core::Random random(seed);
  cv::Mat image(size_px, CV_8U);
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      image.at<unsigned char>(y, x) =
          cv::saturate_cast<unsigned char>(mean + deviation * random.gaussian());
    }
  }
  return image;
}

TEST(PictureStatistics, NoiseIsFoundBesideAnEdge) {
  for (const double deviation : {2.0, 5.0}) {
    cv::Mat image = grey_noise({320, 240}, 90.0, deviation, 1);
    image.colRange(100, 320) += 100;
    // the tenth of the blocks that answers least lies a little below the mean
    EXPECT_NEAR(noise_level(image), deviation, 0.12 * deviation);
  }
  EXPECT_EQ(noise_level(cv::Mat(240, 320, CV_8U, cv::Scalar(255))), 0.0);
}

TEST(PictureStatistics, WhiteNoiseHasNoSlopeAndBlurHasMore) {
  const cv::Mat noise = grey_noise({320, 240}, 128.0, 30.0, 2);
  EXPECT_NEAR(spectrum_slope(noise, 1.0 / 64.0, 1.0 / 3.0), 0.0, 0.1);
  cv::Mat blurred;
  cv::GaussianBlur(noise, blurred, cv::Size(), 1.5);
  EXPECT_GT(spectrum_slope(blurred, 1.0 / 8.0, 1.0 / 3.0), 2.0);
  EXPECT_EQ(spectrum_slope(cv::Mat(240, 320, CV_8U, cv::Scalar(9)), 1.0 / 8.0, 1.0 / 3.0), 0.0);
}

TEST(PictureStatistics, CornersInOneCornerFillOneCell) {
  cv::Mat image(480, 640, CV_8U, cv::Scalar(60));
  cv::rectangle(image, {10, 10}, {25, 25}, cv::Scalar(200), cv::FILLED);
  cv::GaussianBlur(image, image, cv::Size(), 0.8);  // equal neighbours suppress each other
  const PictureStatistics statistics = picture_statistics(image);
  EXPECT_GE(statistics.num_fast_corners, 4.0);
  EXPECT_DOUBLE_EQ(statistics.fast_spread_ratio, 1.0 / (16 * 12));
  EXPECT_GT(statistics.flat_ratio, 0.99);
  EXPECT_THROW(picture_statistics(cv::Mat(63, 640, CV_8U, cv::Scalar(0))), core::ContractError);
}

TEST(OrbMatches, AShiftedPictureMatchesAndNoiseDoesNot) {
  cv::Mat blobs;
  cv::GaussianBlur(grey_noise({420, 340}, 128.0, 120.0, 3), blobs, cv::Size(), 2.0);
  cv::normalize(blobs, blobs, 0, 255, cv::NORM_MINMAX);
  cv::Mat other;
  cv::GaussianBlur(grey_noise({400, 320}, 128.0, 120.0, 4), other, cv::Size(), 2.0);
  cv::normalize(other, other, 0, 255, cv::NORM_MINMAX);
  const OrbFeatures here = extract_orb(blobs(cv::Rect(0, 0, 400, 320)), 500);
  const OrbFeatures shifted = extract_orb(blobs(cv::Rect(20, 20, 400, 320)), 500);
  EXPECT_GT(count_inliers(here, shifted), 100);
  EXPECT_LT(count_inliers(here, extract_orb(other, 500)), 20);
  EXPECT_EQ(count_inliers(here, OrbFeatures()), 0);
}

// A wall 2 m in front of the camera at x = `right_m`, looking straight at it.
ViewGeometry wall_view(double right_m) {
  core::Rig rig;
  rig.cameras.emplace_back(core::PinholeRadtan{
      .width_px = 320, .height_px = 240, .fx_px = 200, .fy_px = 200, .cx_px = 160, .cy_px = 120});
  rig.body_from_camera.emplace_back();
  core::Frame frame;
  frame.rig = std::make_shared<const core::Rig>(rig);
  frame.depth_m = cv::Mat(240, 320, CV_32F, cv::Scalar(2.0F));
  return view_geometry(
      frame, {.rotation = Eigen::Quaterniond::Identity(), .translation = {right_m, 0.0, 0.0}});
}

TEST(ViewPairs, HalfAPictureAsideOverlapsByHalf) {
  // the picture is 3.2 m wide on the wall
  EXPECT_NEAR(shared_view(wall_view(0.0), wall_view(1.6)).overlap, 0.5, 0.03);
  EXPECT_DOUBLE_EQ(shared_view(wall_view(0.0), wall_view(0.0)).overlap, 1.0);
  EXPECT_DOUBLE_EQ(shared_view(wall_view(0.0), wall_view(4.0)).overlap, 0.0);
}

TEST(ViewPairs, ParallaxIsTheAngleBetweenTheDirectionsThatASurfaceIsSeenFrom) {
  // 0.4 m aside at 2 m: 11.4 degrees for what lies between, less towards the sides
  const double parallax_deg = shared_view(wall_view(0.0), wall_view(0.4)).parallax_deg;
  EXPECT_GT(parallax_deg, 9.0);
  EXPECT_LT(parallax_deg, 11.5);
  EXPECT_NEAR(shared_view(wall_view(0.0), wall_view(0.0)).parallax_deg, 0.0, 1e-6);
}

TEST(ViewPairs, ABaselineRunsAsideOrAlongTheViewWhicheverWayRound) {
  const ViewGeometry here = wall_view(0.0);
  const ViewGeometry aside = wall_view(0.3);
  ViewGeometry ahead = here;
  ahead.world_from_camera.translation = {0.1, 0.0, 0.3};
  EXPECT_TRUE(goes(Way::kSideways, here, aside) && goes(Way::kSideways, aside, here));
  EXPECT_TRUE(goes(Way::kForward, here, ahead) && goes(Way::kForward, ahead, here));
  EXPECT_FALSE(goes(Way::kForward, here, aside) || goes(Way::kSideways, here, ahead));
  EXPECT_TRUE(goes(Way::kAny, here, aside) && goes(Way::kAny, here, ahead));
}

TEST(ViewPairs, PairsFallIntoTheirClassAndAreDrawnAlike) {
  EXPECT_EQ(pair_class(wall_view(0.0), wall_view(0.3)), 10);  // 0.15 of the depth, no angle
  EXPECT_EQ(pair_class(wall_view(0.0), wall_view(2.0)), -1);
  std::vector<ViewGeometry> views;
  for (int i = 0; i < 12; ++i) views.push_back(wall_view(0.09 * i));
  const auto pairs = draw_pairs(views, Way::kAny, 5);
  EXPECT_EQ(pairs[0].size(), 5U);
  for (const ViewPair& pair : pairs[10]) {
    const int num_steps = pair.second - pair.first;
    EXPECT_TRUE(num_steps >= 3 && num_steps <= 4) << num_steps;
  }
  const auto again = draw_pairs(views, Way::kAny, 5);
  EXPECT_EQ(pairs[5].front().first, again[5].front().first);
  EXPECT_TRUE(draw_pairs(views, Way::kForward, 5)[10].empty());
}

TEST(ImpostorRule, TheOwnPlaceAndMomentAreTakenOut) {
  KnownFrames frames;
  frames.truth.places = core::PlaceTruthMatrix{
      .num_frames = 4, .values = std::vector<core::PlaceTruth>(16, core::PlaceTruth::kDifferent)};
  frames.truth.places->values[3 * 4 + 0] = core::PlaceTruth::kNear;
  for (int i = 0; i < 4; ++i) {
    frames.names.push_back(std::to_string(i));
    frames.stamps_s.push_back(6.0 * i);
  }
  const ImpostorRule rule = rules_of_truth(frames, 2).front();
  EXPECT_THAT(rule.queries, testing::ElementsAre(0, 2));
  EXPECT_EQ(rule.offer(0, 1), Offer::kTakenOut);  // six seconds later
  EXPECT_EQ(rule.offer(0, 2), Offer::kImpostor);
  EXPECT_EQ(rule.offer(0, 3), Offer::kTakenOut);  // near, said of the other way round
  EXPECT_THROW(rules_of_truth(KnownFrames(), 1), core::InputError);
}

TEST(ImpostorRule, ListedImpostorsAreOfferedToBothFramesAndNothingElseIs) {
  KnownFrames frames;
  frames.truth.aliased_pairs = {{.query = 3, .match = 1}, {.query = 9, .match = 4}};
  const std::vector<ImpostorRule> rules = rules_of_truth(frames, 2);
  ASSERT_EQ(rules.size(), 1U);
  EXPECT_THAT(rules[0].queries, testing::ElementsAre(1, 3, 9));  // 4 is too near 3
  EXPECT_EQ(rules[0].offer(3, 1), Offer::kImpostor);
  EXPECT_EQ(rules[0].offer(1, 3), Offer::kImpostor);
  EXPECT_EQ(rules[0].offer(3, 4), Offer::kTakenOut);
}

TEST(ImpostorRule, OfTheTowerOtherFloorsAreImpostors) {
  const auto folder = std::filesystem::path(testing::TempDir()) / "tower";
  core::make_writable_folder(folder);
  core::write_file(folder / "dataset.csv",
                   "image,floor,split,area\na1,f1,gallery,x y\na2,f1,query,x\nb1,f1,gallery,x\n"
                   "c1,f2,gallery,x\n");
  core::write_file(folder / "walk.txt", "a1 f1 a\na2 f1 a\nb1 f1 b\nc1 f2 c\n");
  ASSERT_TRUE(is_tower(folder));
  const ImpostorRule rule = tower_rule(folder, 150);
  EXPECT_THAT(rule.queries, testing::ElementsAre(1));
  EXPECT_EQ(rule.offer(1, 0), Offer::kTakenOut);
  EXPECT_EQ(rule.offer(1, 2), Offer::kRight);
  EXPECT_EQ(rule.offer(1, 3), Offer::kImpostor);
  core::write_file(folder / "walk.txt", "a1 f1 a\nd9 f1 a\n");
  EXPECT_THROW(tower_rule(folder, 150), core::InputError);
}

}  // namespace
}  // namespace samewhere::bench
