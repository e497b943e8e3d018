#include <memory>
#include <optional>
#include <utility>

#include <gtest/gtest.h>

#include <samewhere/features/test_world.hpp>
#include <samewhere/verify/measure.hpp>

namespace samewhere::verify {
namespace {

core::Candidate pair_of(int query, int match) {
  return {core::CandidateId(0), core::FrameId(static_cast<std::uint64_t>(query)),
          core::FrameId(static_cast<std::uint64_t>(match)), 0.8};
}

const core::Rigid3 kMoved{core::exp_so3({0.05, -0.2, 0.02}), {0.3, 0.05, -0.2}};

TEST(MeasureGeometry, FindsTheRelativePoseOfTheSamePlace) {
  const features::TestWorld world = features::test_world(1);
  const auto evidence = measure_geometry(pair_of(9, 0), features::test_view(world, 9, kMoved),
                                         features::test_view(world, 0, {}), {});
  ASSERT_TRUE(evidence.match_from_query);
  EXPECT_LT(core::log_r3so3(inverse(kMoved) * rigid_part(*evidence.match_from_query)).norm(),
            0.005);
  EXPECT_GE(evidence.num_guided_matches, evidence.num_inliers);
  EXPECT_GT(evidence.num_inliers, 100);
  ASSERT_TRUE(evidence.pose_difference_m && evidence.pose_difference_rad);
  EXPECT_LT(*evidence.pose_difference_m, 0.02);
  EXPECT_LT(*evidence.pose_difference_rad, 0.01);
  EXPECT_GT(evidence.spread_ratio, 0.5);
  // turned by 0.2 rad, which is 100 of 640 pixels
  EXPECT_NEAR(evidence.overlap_ratio, 0.8, 0.1);
  EXPECT_LT(evidence.reprojection_rmse_px, 1.0);
}

TEST(MeasureGeometry, WithoutDepthItCountsEpipolarInliersAndHasNoPose) {
  const features::TestWorld world = features::test_world(1);
  const auto evidence =
      measure_geometry(pair_of(9, 0), features::test_view(world, 9, kMoved, 0.3, false),
                       features::test_view(world, 0, {}, 0.3, false), {});
  EXPECT_FALSE(evidence.match_from_query);
  EXPECT_GT(evidence.num_inliers, 100);
  EXPECT_NEAR(evidence.overlap_ratio, 0.8, 0.1);
}

// What a camera without depth sees, with the depths that a map of this scale has for it.
features::View view_of_scale(const features::TestWorld& world, int frame, const core::Rigid3& pose,
                             double scale) {
  features::View view = features::test_view(world, frame, pose, 0.3, false);
  const features::View truth = features::test_view(world, frame, pose, 0.3, true);
  auto features = std::make_shared<features::Features>(*view.features);
  for (std::size_t i = 0; i < features->depth_m.size(); ++i)
    features->depth_m[i] = static_cast<float>(scale) * truth.features->depth_m[i];
  view.features = std::move(features);
  return view;
}

TEST(MeasureGeometry, BetweenViewsOfTwoScalesItFindsHowMuchLongerOneIs) {
  const features::TestWorld world = features::test_world(1);
  MeasureSettings settings;
  settings.has_one_scale = false;
  const auto evidence = measure_geometry(pair_of(9, 0), view_of_scale(world, 9, kMoved, 0.5),
                                         view_of_scale(world, 0, core::Rigid3{}, 1.5), settings);
  ASSERT_TRUE(evidence.match_from_query);
  EXPECT_NEAR(evidence.match_from_query->scale, 3.0, 0.01);
  EXPECT_LT((evidence.match_from_query->translation - 1.5 * kMoved.translation).norm(), 0.01);
  EXPECT_LT(core::angle_rad(kMoved.rotation.conjugate() * evidence.match_from_query->rotation),
            0.005);
  EXPECT_GT(evidence.num_inliers, 100);
  ASSERT_TRUE(evidence.pose_difference_m);
  EXPECT_LT(*evidence.pose_difference_m, 0.03);
}

// Depth reaches few features only.
features::View with_little_depth(features::View view) {
  auto features = std::make_shared<features::Features>(*view.features);
  for (std::size_t i = 0; i < features->depth_m.size(); ++i)
    if (i % 8 != 0) features->depth_m[i] = 0.0F;
  view.features = std::move(features);
  return view;
}

TEST(MeasureGeometry, InRecognitionAloneLittleDepthIsNoWorseThanNone) {
  const features::TestWorld world = features::test_world(1);
  const features::View query = with_little_depth(features::test_view(world, 9, kMoved));
  const features::View match = with_little_depth(features::test_view(world, 0, {}));
  MeasureSettings settings;
  const auto with_map = measure_geometry(pair_of(9, 0), query, match, settings);
  EXPECT_TRUE(with_map.match_from_query) << "SLAM needs the pose";
  settings.verify.require_pose = false;
  settings.verify.min_inliers_in_sequence = with_map.num_inliers + 1;
  const auto alone = measure_geometry(pair_of(9, 0), query, match, settings);
  EXPECT_FALSE(alone.match_from_query);
  EXPECT_GT(alone.num_inliers, 2 * with_map.num_inliers);
  settings.verify.min_inliers_in_sequence = with_map.num_inliers;
  const auto both = measure_geometry(pair_of(9, 0), query, match, settings);
  EXPECT_TRUE(both.match_from_query);
  EXPECT_EQ(both.num_inliers, alone.num_inliers);
}

TEST(MeasureGeometry, TwoPlacesHaveFewInliers) {
  const auto evidence =
      measure_geometry(pair_of(9, 0), features::test_view(features::test_world(1), 9, {}),
                       features::test_view(features::test_world(2), 0, {}), {});
  EXPECT_LT(evidence.num_inliers, 15);
}

TEST(MeasureGeometry, ABlackViewGivesZeros) {
  const features::View black = features::test_view({}, 9, {});
  const auto evidence = measure_geometry(pair_of(9, 0), black,
                                         features::test_view(features::test_world(1), 0, {}), {});
  EXPECT_EQ(evidence.num_matches, 0);
  EXPECT_EQ(evidence.num_inliers, 0);
  EXPECT_EQ(evidence.spread_ratio, 0.0);
}

TEST(MeasureGeometry, TheSamePairGivesTheSameBitsWheneverItIsAsked) {
  const features::TestWorld world = features::test_world(4);
  const features::View query = features::test_view(world, 9, kMoved);
  const features::View match = features::test_view(world, 0, {});
  const auto first = measure_geometry(pair_of(9, 0), query, match, {});
  measure_geometry(pair_of(9, 3), query, match, {});
  const auto second = measure_geometry(pair_of(9, 0), query, match, {});
  EXPECT_EQ(first.match_from_query->translation, second.match_from_query->translation);
  EXPECT_EQ(first.num_inliers, second.num_inliers);
}

}  // namespace
}  // namespace samewhere::verify
