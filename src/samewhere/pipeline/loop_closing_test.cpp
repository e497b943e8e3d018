#include <map>
#include <optional>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include <samewhere/pipeline/loop_closing.hpp>
#include <samewhere/pipeline/test_rooms.hpp>

namespace samewhere::pipeline {
namespace {

// Each keyframe of the walk asks in turn; all images are the same, so that the map alone decides
// which of them are worth a look.
class LoopClosingInRooms : public LookAlikeRooms {
 protected:
  LoopClosingInRooms() : picture_(480, 640, CV_8UC1) {
    config_.retrieve.window_frames = 1;
    cv::RNG(1).fill(picture_, cv::RNG::UNIFORM, 0, 255);
  }

  // The keyframe `starts_map` (none: no keyframe) is said to start a map of its own.
  core::Ledger ledger_of_walk(std::optional<std::size_t> starts_map = {}) {
    LoopClosing closing(config_);
    for (std::size_t i = 0; i < map_.keyframes.size(); ++i) {
      closing.answer(
          ToLoopClosing(FindLoops{map_, map_.keyframes[i].id, picture_, starts_map == i}));
    }
    return closing.ledger();
  }

  // The map so far with the described views of all its keyframes.
  scene::StoredMap stored() const {
    scene::StoredMap known{.map = map_, .extras = {}};
    const PlaceIndex index(config_);
    for (std::size_t i = 0; i < map_.keyframes.size(); ++i)
      known.extras.descriptors.push_back(index.describe(map_.keyframes[i].view.frame, picture_));
    return known;
  }

  cv::Mat picture_;
};

TEST_F(LoopClosingInRooms, KeyframesWithCommonLandmarksAreNoCandidates) {
  const core::Ledger ledger = ledger_of_walk();
  ASSERT_FALSE(ledger.empty());
  for (const core::LedgerRow& row : ledger) {
    EXPECT_GE(row.candidate.query.index(), kPerRoom);
    EXPECT_LT(row.candidate.match.index(), kPerRoom);
  }
}

TEST_F(LoopClosingInRooms, KeyframesThatShareLandmarksAreOnePlace) {
  std::map<core::FrameId, int> num_candidates;
  for (const core::LedgerRow& row : ledger_of_walk()) ++num_candidates[row.candidate.query];
  ASSERT_EQ(num_candidates.size(), kPerRoom) << "all of the second room";
  for (const auto& [query, count] : num_candidates)
    EXPECT_EQ(count, config_.retrieve.views_per_place) << "the first room is one place";
}

TEST_F(LoopClosingInRooms, ViewsOfAMapThatWasGivenUpAreNoCandidates) {
  EXPECT_FALSE(ledger_of_walk(1).empty()) << "the second room is like the rest of the first";
  EXPECT_TRUE(ledger_of_walk(kPerRoom).empty()) << "nothing is left of the first room";
}

TEST_F(LoopClosingInRooms, NorAreThoseOfAStoredMap) {
  EXPECT_EQ(LoopClosing(config_, stored()).index().num_descriptors(), 2 * int{kPerRoom});
  map_ = apply(map_, map::give_up(map_));
  EXPECT_EQ(LoopClosing(config_, stored()).index().num_descriptors(), 0);
}

TEST_F(LoopClosingInRooms, AskedAgainWithNothingThatWaitsItAnswersNothing) {
  LoopClosing closing(config_);
  closing.answer(ToLoopClosing(FindLoops{map_, map_.keyframes[0].id, picture_}));
  const LoopAnswer answer = closing.answer(ToLoopClosing(AskAgain{map_}));
  EXPECT_TRUE(answer.rows.empty());
  EXPECT_TRUE(answer.loops.empty());
}

}  // namespace
}  // namespace samewhere::pipeline
