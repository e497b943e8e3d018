#include <gtest/gtest.h>

#include <samewhere/pipeline/place_evidence.hpp>

namespace samewhere::pipeline {
namespace {

constexpr double kConfirmed = 2.5;  // track.relocalization.min_log_ratio
constexpr PlaceView kExplained{.found_ratio = 1.05, .new_ratio = 0.3, .moved_m = 0.25};
constexpr PlaceView kUnexplained{.found_ratio = 0.05, .new_ratio = 1.0, .moved_m = 0.25};

PlaceEvidence after(int num_views, const PlaceView& view,
                    PlaceEvidence evidence = PlaceEvidence(20.0)) {
  for (int i = 0; i < num_views; ++i) evidence.add(view);
  return evidence;
}

TEST(PlaceEvidence, LandmarksThatWereSeenBeforeAddNothing) {
  PlaceView again = kExplained;
  again.new_ratio = 0.0;
  EXPECT_NEAR(after(1000, again).log_likelihood_ratio(), 0.0, 1e-9);
}

TEST(PlaceEvidence, GrowsWithMetresThatAreExplained) {
  const double short_walk = after(8, kExplained).log_likelihood_ratio();
  const double long_walk = after(80, kExplained).log_likelihood_ratio();
  EXPECT_GT(short_walk, 0.0);
  EXPECT_GT(long_walk, short_walk);
  EXPECT_LT(long_walk, kConfirmed) << "20 m of a corridor may be those of its look-alike";
}

TEST(PlaceEvidence, MetresCountLessWhereLookAlikesGoOnForLonger) {
  EXPECT_GT(after(200, kExplained).log_likelihood_ratio(), kConfirmed);
  EXPECT_LT(after(200, kExplained, PlaceEvidence(100.0)).log_likelihood_ratio(), kConfirmed);
}

TEST(NewGround, APathForthAndBackCountsOnce) {
  NewGround ground;
  double counted_m = 0.0;
  for (int i = 1; i <= 100; ++i) counted_m += ground.add({0.2 * i, 0.0, 0.0}, 0.2);
  EXPECT_NEAR(counted_m, 20.0, 1e-9);
  for (int i = 99; i >= 0; --i) counted_m += ground.add({0.2 * i, 0.5, 0.0}, 0.2);
  EXPECT_LT(counted_m, 20.0 + 3.0) << "only where it turns";
  for (int i = 1; i <= 50; ++i) counted_m += ground.add({0.0, 0.2 * i, 0.0}, 0.2);
  EXPECT_GT(counted_m, 20.0 + 7.0) << "a corridor that crosses it is new";
}

TEST(PlaceEvidence, FallsWhereTheCameraLeavesALookAlike) {
  const PlaceEvidence in_common = after(20, kExplained);
  EXPECT_LT(after(6, kUnexplained, in_common).log_likelihood_ratio(), -kConfirmed);
  EXPECT_GT(after(1, kUnexplained, in_common).log_likelihood_ratio(), -kConfirmed)
      << "a person may have passed";
}

TEST(PlaceEvidence, FewInliersThroughoutNeitherConfirmNorTakeBack) {
  PlaceView less = kExplained;
  less.found_ratio = 0.6;  // a look-alike, or the place in another light
  const double log_ratio = after(80, less).log_likelihood_ratio();
  EXPECT_LT(log_ratio, 1.0);
  EXPECT_GT(log_ratio, -kConfirmed);
}

TEST(PlaceEvidence, AMappedLookAlikeShowsHowMuchLookAlikesDiffer) {
  EXPECT_GT(log_ratio_by_lookalike(1.05, 0.6, 3.0), kConfirmed);
  EXPECT_LT(log_ratio_by_lookalike(1.05, 0.95, 10.0), 1.5) << "nearly the same";
  EXPECT_LT(log_ratio_by_lookalike(0.65, 0.7, 10.0), 0.0) << "the winner may be one, too";
  EXPECT_EQ(log_ratio_by_lookalike(1.05, 0.6, 0.0), 0.0) << "no view";
}

// The same wing one floor up may differ less than the other wing.
TEST(PlaceEvidence, APlaceThatIsNotInTheMapMayBeCloserThanTheMappedLookAlike) {
  EXPECT_LT(log_ratio_by_lookalike(0.95, 0.6, 20.0), kConfirmed);
  EXPECT_LT(log_ratio_by_lookalike(0.85, 0.6, 20.0), 0.5);
  EXPECT_GT(log_ratio_by_lookalike(1.05, 0.6, 20.0), kConfirmed);
  EXPECT_LT(log_ratio_by_lookalike(1.05, 0.1, 1e6), 4.5) << "however different the mapped one is";
}

TEST(PlaceEvidence, TooFewInliersSpeakAgainstAPlaceUnlessItHasChanged) {
  EXPECT_LT(log_ratio_by_lookalike(0.73, 0.86, 2.5), -1.0);
  EXPECT_GT(log_ratio_by_lookalike(0.73, 0.86, 1e6), -3.0) << "a changed place has as few";
}

TEST(PlaceEvidence, ALookAlikeExplainsMuchOrForLong) {
  EXPECT_TRUE(is_lookalike(0.5, 4));
  EXPECT_FALSE(is_lookalike(0.25, 4)) << "it may share a door";
  EXPECT_TRUE(is_lookalike(0.25, 10));
  EXPECT_FALSE(is_lookalike(0.1, 30));
}

}  // namespace
}  // namespace samewhere::pipeline
