#include <memory>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <samewhere/features/test_world.hpp>
#include <samewhere/verify/sequence.hpp>
#include <samewhere/verify/view_counter.hpp>

namespace samewhere::verify {
namespace {

std::vector<Claim> claims(const std::vector<ViewPair>& pairs) {
  std::vector<Claim> claims;
  for (const ViewPair& pair : pairs) claims.push_back({pair, 30});
  return claims;
}

std::vector<int> lengths(const std::vector<Claim>& claims, int max_gap = 3) {
  std::vector<int> lengths;
  for (const Sequence& sequence : longest_sequences(claims, max_gap))
    lengths.push_back(sequence.num_views);
  return lengths;
}

using Lengths = std::vector<int>;

TEST(LongestSequences, AWalkSeenAgainIsOneAndAStrayLookAlikeStaysAlone) {
  EXPECT_EQ(lengths(claims({{50, 10}, {51, 11}, {52, 12}, {52, 40}, {53, 13}})),
            (Lengths{4, 4, 4, 1, 4}));
}

TEST(LongestSequences, GoesOnOverAGapAndNoFurther) {
  EXPECT_EQ(lengths(claims({{50, 10}, {53, 12}, {57, 13}})), (Lengths{2, 2, 1}));
  EXPECT_EQ(lengths(claims({{50, 10}, {53, 12}, {57, 13}}), 4), (Lengths{3, 3, 3}));
  EXPECT_EQ(lengths(claims({{50, 10}, {51, 14}})), (Lengths{1, 1})) << "the match jumps";
}

TEST(LongestSequences, MayGoTheOtherWayRoundButNotToAndFro) {
  EXPECT_EQ(lengths(claims({{50, 12}, {51, 11}, {52, 10}})), (Lengths{3, 3, 3}));
  EXPECT_EQ(lengths(claims({{50, 10}, {51, 12}, {52, 11}, {53, 13}})), (Lengths{3, 3, 3, 3}));
  EXPECT_EQ(longest_sequences(claims({{50, 12}, {51, 11}}), 3)[0].step, -1);
}

TEST(LongestSequences, EachViewCountsOnce) {
  // one door that everything matches, and a camera that stands still
  EXPECT_EQ(lengths(claims({{50, 10}, {51, 10}, {52, 10}})), (Lengths{1, 1, 1}));
  EXPECT_EQ(lengths(claims({{50, 10}, {50, 11}, {50, 12}})), (Lengths{1, 1, 1}));
}

TEST(LongestSequences, KnowsItsEndsAndTheInliersOfItsBestClaims) {
  const std::vector<Claim> all = {{{50, 10}, 30}, {{51, 11}, 20}, {{51, 11}, 90}, {{53, 12}, 40}};
  const std::vector<Sequence> found = longest_sequences(all, 3);
  EXPECT_EQ(found[0].num_inliers, 160);
  EXPECT_EQ(found[1].num_inliers, 90) << "through the weaker of two pictures of one view";
  EXPECT_EQ(found[3].first, (ViewPair{50, 10}));
  EXPECT_EQ(found[0].last, (ViewPair{53, 12}));
}

TEST(LongestSequences, NoClaimsAreNoSequences) { EXPECT_TRUE(longest_sequences({}, 3).empty()); }

TEST(ViewCounter, StandingStillIsOneViewAndTurningAwayAnother) {
  const features::TestWorld world = features::test_world(1);
  const core::Rigid3 moved_a_little{core::exp_so3({0.0, 0.01, 0.0}), {0.01, 0.0, 0.0}};
  const features::TestWorld elsewhere = features::test_world(2);
  ViewCounter counter({}, 0.15);
  EXPECT_EQ(counter.count(features::test_view(world, 0, {})), 0);
  EXPECT_EQ(counter.count(features::test_view(world, 1, {})), 0);
  EXPECT_EQ(counter.count(features::test_view(world, 2, moved_a_little)), 0);
  EXPECT_EQ(counter.count(features::test_view(elsewhere, 3, {})), 1);
  EXPECT_EQ(counter.count(features::test_view(world, 4, {})), 2) << "seen before, but not just now";
}

TEST(ViewCounter, ABlackFrameIsNoNewView) {
  const features::TestWorld world = features::test_world(1);
  features::View black = features::test_view(world, 0, {});
  black.features = std::make_shared<features::Features>();
  ViewCounter counter({}, 0.15);
  EXPECT_EQ(counter.count(black), 0);
  EXPECT_EQ(counter.count(features::test_view(world, 1, {})), 0);
  EXPECT_EQ(counter.count(black), 0);
}

}  // namespace
}  // namespace samewhere::verify
