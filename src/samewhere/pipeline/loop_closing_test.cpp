#include <map>

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
  core::Ledger ledger_of_walk() {
    config_.retrieve.window_frames = 1;
    cv::Mat picture(480, 640, CV_8UC1);
    cv::RNG(1).fill(picture, cv::RNG::UNIFORM, 0, 255);
    LoopClosing closing(config_);
    for (std::size_t i = 0; i < map_.keyframes.size(); ++i)
      closing.answer(ToLoopClosing(FindLoops{map_, map_.keyframes[i].id, picture}));
    return closing.ledger();
  }
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

}  // namespace
}  // namespace samewhere::pipeline
