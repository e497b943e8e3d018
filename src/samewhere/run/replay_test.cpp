#include <gtest/gtest.h>

#include <samewhere/run/replay.hpp>
#include <samewhere/verify/decide.hpp>

namespace samewhere::run {
namespace {

core::Candidate candidate(std::uint64_t id, double similarity = 0.5) {
  return {core::CandidateId(id), core::FrameId(100 + id), core::FrameId(id), similarity};
}

core::Evidence evidence(int num_inliers) {
  core::Evidence evidence{.similarity = 0.5};
  evidence.geometry = core::GeometryEvidence{.num_matches = 200,
                                             .num_inliers = num_inliers,
                                             .inlier_ratio = 0.5,
                                             .spread_ratio = 0.5,
                                             .match_from_query = core::Sim3{}};
  evidence.odometry = core::OdometryEvidence{.sigma_m = 0.1, .look_alike_gain = 900.0};
  return evidence;
}

core::LedgerRow verified(std::uint64_t id, const core::Evidence& evidence) {
  return {candidate(id), verify::decide(candidate(id), evidence, {}, {})};
}

TEST(Replay, WithTheThresholdsOfTheRunNothingChanges) {
  const core::Ledger ledger = {verified(0, evidence(30)), verified(1, evidence(60))};
  for (const auto& row : replay(ledger, {})) EXPECT_EQ(row.outcome, Replay::kSame);
}

TEST(Replay, AThresholdMovesThoseBetweenTheOldAndTheNewOne) {
  const core::Ledger ledger = {verified(0, evidence(30)), verified(1, evidence(60)),
                               verified(2, evidence(90))};
  const auto stricter = replay(ledger, {.min_inliers = 80});
  EXPECT_EQ(stricter[0].outcome, Replay::kSame);
  EXPECT_EQ(stricter[1].outcome, Replay::kChanged);
  EXPECT_FALSE(core::is_loop(stricter[1].after));
  EXPECT_TRUE(core::is_loop(stricter[2].after));
  const auto laxer = replay(ledger, {.min_inliers = 20});
  EXPECT_EQ(laxer[0].outcome, Replay::kChanged);
  EXPECT_TRUE(core::is_loop(laxer[0].after));
}

TEST(Replay, WhatWasNeverMeasuredIsNotGuessed) {
  const core::Evidence alone{.similarity = 0.5};
  const core::LedgerRow row{candidate(0),
                            verify::decide(candidate(0), alone, {}, {.min_similarity = 0.6})};
  EXPECT_EQ(replay({row}, {.min_similarity = 0.4})[0].outcome, Replay::kUnmeasured);
  EXPECT_EQ(replay({row}, {.min_similarity = 0.55})[0].outcome, Replay::kSame);
  EXPECT_EQ(replay({row}, {.min_similarity = 0.4, .require_geometry = false})[0].outcome,
            Replay::kChanged);
}

TEST(Replay, ThePauseFollowsTheNewVerdicts) {
  const core::Ledger ledger = {verified(0, evidence(60)), verified(1, evidence(60)),
                               verified(2, evidence(60))};
  const auto paused = replay(ledger, {.pause_frames = 1});
  EXPECT_TRUE(core::is_loop(paused[0].after));
  EXPECT_FALSE(core::is_loop(paused[1].after));
  EXPECT_TRUE(core::is_loop(paused[2].after));
}

TEST(Replay, ASequenceIsCountedAgainFromCandidatesThatPassNow) {
  verify::Config few;
  few.prior = verify::Prior::kUnique;
  few.require_pose = false;
  few.min_views = 3;
  few.min_inliers = 70;  // of a view alone
  core::Ledger ledger;
  for (std::uint64_t id = 0; id < 4; ++id) {
    core::Evidence alone = evidence(id == 1 ? 25 : 60);
    alone.geometry->match_from_query.reset();
    alone.sequence = core::SequenceEvidence{.query_view = 50 + static_cast<int>(id),
                                            .match_view = 10 + static_cast<int>(id),
                                            .num_views = 4,
                                            .num_inliers = 205,
                                            .is_over = true};
    ledger.push_back({candidate(id), verify::decide(candidate(id), alone, {}, few)});
    EXPECT_TRUE(core::is_loop(ledger.back().verdict));
  }
  for (const auto& row : replay(ledger, few)) EXPECT_TRUE(core::is_loop(row.after));
  few.min_inliers_in_sequence = 30;  // three are left
  const auto stricter = replay(ledger, few);
  EXPECT_EQ(core::stage_of(stricter[1].after), "inliers");
  EXPECT_EQ(core::evidence_of(stricter[3].after).sequence->num_views, 3);
  EXPECT_EQ(stricter[3].outcome, Replay::kSame);
  few.min_views = 4;
  EXPECT_EQ(core::stage_of(replay(ledger, few)[0].after), "sequence");
}

TEST(Replay, FromAmbiguousToRejectedIsAChange) {
  core::Evidence uncertain = evidence(60);
  uncertain.odometry->look_alike_gain = 1.0;
  const core::LedgerRow row = verified(0, uncertain);
  ASSERT_EQ(core::name_of(row.verdict), "AMBIGUOUS");
  EXPECT_EQ(replay({row}, {})[0].outcome, Replay::kSame);
  EXPECT_EQ(replay({row}, {.min_inliers = 80})[0].outcome, Replay::kChanged);
}

TEST(Replay, AskingAgainIsNotReplayed) {
  core::Evidence contradicted = evidence(60);
  contradicted.odometry->mahalanobis_squared_with_loops = 1000.0;
  core::LedgerRow row = verified(0, contradicted);
  ASSERT_EQ(core::stage_of(row.verdict), "competing");
  row.verdict = core::Rejection{row.candidate.id, contradicted, core::Refusal::kCompeting, "asked"};
  EXPECT_EQ(replay({row}, {})[0].outcome, Replay::kSame);
}

TEST(Replay, ARelocalizationNeedsNoRelativePose) {
  core::Evidence alone = evidence(60);
  alone.geometry->match_from_query.reset();
  core::LedgerRow row = verified(0, alone);
  row.candidate.origin = core::Origin::kRelocalization;
  row.verdict = verify::decide(row.candidate, alone, {}, {.require_pose = false, .min_views = 1});
  ASSERT_TRUE(core::is_loop(row.verdict));
  EXPECT_EQ(replay({row}, {})[0].outcome, Replay::kSame);
  EXPECT_EQ(replay({row}, {.min_inliers = 80})[0].outcome, Replay::kChanged);
}

TEST(Replay, WhatNeverWaitedCannotBeSaidToHaveWaitedInVain) {
  core::Evidence alone = evidence(60);
  alone.geometry->match_from_query.reset();
  const core::LedgerRow row = verified(0, alone);
  EXPECT_EQ(core::stage_of(row.verdict), "pose");
  EXPECT_EQ(replay({row}, {.require_pose = false})[0].outcome, Replay::kUnmeasured);
}

TEST(Replay, ALoopOfAnEarlierVersionLacksTheMeasurementOfItsPrior) {
  core::LedgerRow row = verified(0, evidence(60));
  auto& loop = std::get<core::LoopClosure>(row.verdict);
  loop.evidence.odometry = core::OdometryEvidence{.mahalanobis_squared = 2.0};
  EXPECT_EQ(replay({row}, {})[0].outcome, Replay::kUnmeasured);
  EXPECT_EQ(replay({row}, {.prior = verify::Prior::kUnique})[0].outcome, Replay::kSame);
}

TEST(Replay, WhatTheGraphRefusedStaysRefused) {
  core::LedgerRow row = verified(0, evidence(60));
  row.verdict = core::Rejection{row.candidate.id, evidence(60), core::Refusal::kWithdrawn, "bent"};
  EXPECT_EQ(replay({row}, {})[0].outcome, Replay::kGraph);
  EXPECT_EQ(replay({row}, {.min_inliers = 80})[0].outcome, Replay::kSame);
}

}  // namespace
}  // namespace samewhere::run
