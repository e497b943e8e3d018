#include <vector>

#include <gtest/gtest.h>

#include <samewhere/pipeline/place_hypothesis.hpp>

namespace samewhere::pipeline {
namespace {

constexpr int kWeakInliers = 40;
constexpr int kVisibleInCell = 20;

// A recognised place with so many inliers in each cell of `num_views` views.
PlaceHypothesis place_with(int inliers_in_cell, int num_views) {
  PlaceHypothesis place(60.0);
  place.place.is_recognised = true;
  for (int i = 0; i < num_views; ++i) {
    ViewEvidence view;
    view.frame = core::FrameId(static_cast<std::uint64_t>(i));
    view.is_comparable = true;
    view.cells.fill({inliers_in_cell, kVisibleInCell});
    for (const Counts& cell : view.cells) view.total += cell;
    place.views.push_back(view);
    const double found_ratio = 1.0 * inliers_in_cell / kVisibleInCell;
    place.evidence.add({.found_ratio = found_ratio, .new_ratio = 1.0, .moved_m = 0.2});
  }
  return place;
}

double log_ratio_of_first(const std::vector<PlaceHypothesis>& all) {
  return log_ratio(all.front(), all, kWeakInliers);
}

TEST(PlaceHypothesis, ALookAlikeInTheMapConfirmsThePlaceThatIsFoundBetter) {
  const PlaceHypothesis place = place_with(20, 6);
  const double alone = log_ratio_of_first({place});
  EXPECT_GT(log_ratio_of_first({place, place_with(10, 6)}), alone + 1.0);
  EXPECT_NEAR(log_ratio_of_first({place, place_with(20, 6)}), alone, 0.2) << "found as well";
}

TEST(PlaceHypothesis, APlaceThatIsNotRecognisedIsNoLookAlike) {
  PlaceHypothesis other = place_with(10, 6);
  other.place.is_recognised = false;
  const PlaceHypothesis place = place_with(20, 6);
  EXPECT_DOUBLE_EQ(log_ratio_of_first({place, other}), log_ratio_of_first({place}));
}

TEST(PlaceHypothesis, AFewViewsOfAnotherPlaceAreNotCompared) {
  const PlaceHypothesis place = place_with(20, 6);
  EXPECT_DOUBLE_EQ(log_ratio_of_first({place, place_with(10, 3)}), log_ratio_of_first({place}));
}

TEST(PlaceHypothesis, CompetesWithARecognisedPlaceUntilThatWasSeenOftenAndIsFoundLess) {
  const auto is_alone_beside = [](const PlaceHypothesis& other) {
    const std::vector<PlaceHypothesis> all{place_with(20, 6), other};
    return is_alone(all.front(), all, kWeakInliers);
  };
  EXPECT_FALSE(is_alone_beside(place_with(10, 3)));
  EXPECT_TRUE(is_alone_beside(place_with(10, 6)));
  EXPECT_FALSE(is_alone_beside(place_with(19, 6)));
}

TEST(PlaceHypothesis, IsInTheMapWhereItsLastViewShowsLandmarks) {
  EXPECT_FALSE(place_with(20, 0).is_in_map());
  PlaceHypothesis place = place_with(20, 1);
  EXPECT_TRUE(place.is_in_map());
  place.views.back().total = {5, 10};
  EXPECT_FALSE(place.is_in_map());
}

}  // namespace
}  // namespace samewhere::pipeline
