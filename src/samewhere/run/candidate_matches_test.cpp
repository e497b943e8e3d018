#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <samewhere/pipeline/test_rooms.hpp>
#include <samewhere/run/candidate_matches.hpp>
#include <samewhere/run/position_covariances.hpp>

namespace samewhere::run {
namespace {

// Candidates between keyframes of two rooms.
class CandidateMatches : public pipeline::LookAlikeRooms {
 protected:
  CandidateMatches() { map_ = with_next(with_next(map_)); }

  static core::LedgerRow rejected(const scene::LoopEdge& loop, std::size_t id, bool has_pose) {
    const core::Candidate candidate{.id = core::CandidateId(id),
                                    .query = core::FrameId(loop.query.index()),
                                    .match = core::FrameId(loop.match.index()),
                                    .similarity = 0.8};
    core::Rejection rejection{candidate.id, {.similarity = 0.8}, core::Refusal::kOdometry, "far"};
    rejection.evidence.geometry.emplace();
    if (has_pose)
      rejection.evidence.geometry->match_from_query = core::Sim3::from_rigid(loop.match_from_query);
    return {candidate, rejection};
  }

  static auto num_inliers(const std::vector<report::ImageMatch>& matches) {
    return std::ranges::count_if(matches, &report::ImageMatch::is_inlier);
  }
};

TEST_F(CandidateMatches, FitTheTruePoseAndNotAnother) {
  scene::LoopEdge moved = true_loop(11, 10);
  moved.match_from_query.translation.x() += 0.5;
  const core::Ledger ledger = {rejected(true_loop(11, 10), 0, true), rejected(moved, 1, true),
                               rejected(true_loop(11, 10), 2, false)};
  const auto matches = candidate_matches(ledger, map_, config_, 10);
  ASSERT_EQ(matches.size(), 3U);
  const auto& of_true = matches.at(core::CandidateId(0));
  EXPECT_GT(of_true.size(), 20U);
  EXPECT_GT(num_inliers(of_true), static_cast<std::ptrdiff_t>(of_true.size() / 2));
  EXPECT_LT(num_inliers(matches.at(core::CandidateId(1))), 5);
  EXPECT_EQ(num_inliers(matches.at(core::CandidateId(2))), 0) << "no pose, no inliers";
  for (const report::ImageMatch& match : of_true) {
    EXPECT_GE(match.in_query.minCoeff(), 0.0F);
    EXPECT_LE(match.in_query.maxCoeff(), 1.0F);
  }
}

TEST_F(CandidateMatches, AreLimitedAndOfKeyframesOnly) {
  core::LedgerRow of_no_keyframe = rejected(true_loop(11, 10), 0, true);
  of_no_keyframe.candidate.match = core::FrameId(999);
  const core::Ledger ledger = {of_no_keyframe, rejected(true_loop(11, 10), 1, true),
                               rejected(true_loop(11, 9), 2, true)};
  const auto matches = candidate_matches(ledger, map_, config_, 1);
  ASSERT_EQ(matches.size(), 1U);
  EXPECT_TRUE(matches.contains(core::CandidateId(1)));
}

TEST_F(CandidateMatches, CovariancesGrowWithTheDistance) {
  const auto covariances = position_covariances(map_, 0, config_, 100);
  ASSERT_GT(covariances.size(), 5U);
  EXPECT_GT(covariances.back().in_world_m2.trace(), covariances.front().in_world_m2.trace());
  EXPECT_LE(position_covariances(map_, 0, config_, 3).size(), 3U);
  EXPECT_TRUE(position_covariances(map_, 7, config_, 3).empty()) << "no keyframe of session 7";
}

bool has_limit(const verify::Config& config, const std::string& score, double value) {
  return std::ranges::any_of(score_limits(config), [&](const report::ScoreLimit& limit) {
    return limit.score == score && limit.value == value;
  });
}

TEST(ScoreLimits, AreThoseOfTheChecksInForce) {
  verify::Config config;
  EXPECT_TRUE(has_limit(config, "num_inliers", config.min_inliers));
  EXPECT_TRUE(has_limit(config, "look_alike_gain", config.min_look_alike_gain));
  config.prior = verify::Prior::kUnique;
  EXPECT_FALSE(has_limit(config, "look_alike_gain", config.min_look_alike_gain));
  config.require_pose = false;
  EXPECT_TRUE(has_limit(config, "num_inliers", config.min_inliers_in_sequence));
  EXPECT_TRUE(has_limit(config, "num_sequence_views", config.min_views));
  config.method = verify::Method::kDeformation;
  EXPECT_FALSE(has_limit(config, "mahalanobis_squared", config.max_odometry_chi_square));
}

}  // namespace
}  // namespace samewhere::run
