#include <map>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include <samewhere/verify/waiting_candidates.hpp>

namespace samewhere::verify {
namespace {

// A map in which a test sets what odometry and loops say of each match.
class MapWithLoops final : public WithoutMap {
 public:
  std::vector<core::CandidateId> closed;
  std::map<core::FrameId, core::OdometryEvidence> odometry;
  std::optional<core::CompetingLoopEvidence> competing_loop;

  std::vector<core::CandidateId> loops() const override { return closed; }
  std::optional<core::OdometryEvidence> measure_odometry(
      const core::Candidate& candidate, const core::Sim3& /*match_from_query*/) const override {
    const auto found = odometry.find(candidate.match);
    return found == odometry.end() ? std::nullopt : std::optional(found->second);
  }
  std::optional<core::CompetingLoopEvidence> measure_competing_loop(
      const core::Candidate& /*candidate*/, const core::Sim3& /*match_from_query*/) const override {
    return competing_loop;
  }
};

constexpr core::OdometryEvidence kUncertain{.sigma_m = 2.0, .look_alike_gain = 2.0};
constexpr core::OdometryEvidence kTold{.sigma_m = 0.3,
                                       .look_alike_gain = 2.0,
                                       .look_alike_gain_with_loops = 80.0,
                                       .mahalanobis_squared_with_loops = 3.0};
constexpr core::OdometryEvidence kContradicted{.sigma_m = 0.3,
                                               .look_alike_gain = 2.0,
                                               .look_alike_gain_with_loops = -60.0,
                                               .mahalanobis_squared_with_loops = 90.0};

class Waiting : public testing::Test {
 protected:
  core::LedgerRow row_of(int query, int match, int num_inliers = 90) {
    const core::Candidate candidate{core::CandidateId(num_rows_++),
                                    core::FrameId(static_cast<std::uint64_t>(query)),
                                    core::FrameId(static_cast<std::uint64_t>(match)), 0.8};
    core::Evidence evidence{.similarity = 0.8};
    evidence.geometry = core::GeometryEvidence{.num_matches = 120,
                                               .num_inliers = num_inliers,
                                               .spread_ratio = 0.5,
                                               .match_from_query = core::Sim3{}};
    evidence = verifier_.measured_again(candidate, evidence, map_);
    return {candidate, verifier_.decide(candidate, evidence, {})};
  }

  // As with each keyframe.
  std::vector<core::LedgerRow> asked_again() {
    return waiting_.ask_again(map_, verifier_.config().asked_again_per_keyframe);
  }

  LoopVerifier verifier_{VerifierSettings{}};
  MapWithLoops map_;
  WaitingCandidates waiting_{verifier_};
  std::uint64_t num_rows_ = 0;
};

TEST_F(Waiting, BecomesALoopOnceOtherLoopsTellItsPlaceFromALookAlike) {
  map_.odometry[core::FrameId(3)] = kUncertain;
  const core::LedgerRow row = row_of(50, 3);
  ASSERT_EQ(core::stage_of(row.verdict), "evidence");
  waiting_.add({row});
  EXPECT_TRUE(asked_again().empty()) << "nothing has changed";
  map_.closed = {core::CandidateId(7)};
  map_.odometry[core::FrameId(3)] = kTold;
  const auto decided = asked_again();
  ASSERT_EQ(decided.size(), 1U);
  EXPECT_TRUE(core::is_loop(decided[0].verdict));
  EXPECT_EQ(decided[0].candidate.id, row.candidate.id);
  map_.closed.emplace_back(8);
  EXPECT_TRUE(asked_again().empty()) << "decided once";
}

TEST_F(Waiting, IsRejectedByLoopsAndBecomesALoopAfterTheirWithdrawal) {
  map_.odometry[core::FrameId(3)] = kUncertain;
  waiting_.add({row_of(50, 3)});
  map_.closed = {core::CandidateId(7)};
  map_.odometry[core::FrameId(3)] = kContradicted;
  const auto rejected = asked_again();
  ASSERT_EQ(rejected.size(), 1U);
  EXPECT_EQ(core::name_of(rejected[0].verdict), "NOT");
  EXPECT_EQ(core::stage_of(rejected[0].verdict), "competing");
  map_.closed = {core::CandidateId(9)};
  map_.odometry[core::FrameId(3)] = kTold;
  const auto accepted = asked_again();
  ASSERT_EQ(accepted.size(), 1U);
  EXPECT_TRUE(core::is_loop(accepted[0].verdict));
}

TEST_F(Waiting, ThatALoopWithABetterFitRejectsItIsTakenBackWithThatLoop) {
  map_.odometry[core::FrameId(3)] = kTold;
  map_.closed = {core::CandidateId(7)};
  map_.competing_loop = core::CompetingLoopEvidence{
      .frame = core::FrameId(9), .mahalanobis_squared = 75.0, .gain = -25.0};
  const core::LedgerRow row = row_of(50, 3);
  ASSERT_EQ(core::name_of(row.verdict), "NOT");
  waiting_.add({row});
  EXPECT_TRUE(asked_again().empty()) << "that loop is still there";
  map_.closed = {core::CandidateId(8)};
  map_.competing_loop.reset();
  const auto decided = asked_again();
  ASSERT_EQ(decided.size(), 1U);
  EXPECT_TRUE(core::is_loop(decided[0].verdict));
}

TEST_F(Waiting, TwoPlacesOfOneViewAreDecidedWhenLoopsRuleOneOut) {
  map_.odometry[core::FrameId(3)] = kTold;
  map_.odometry[core::FrameId(20)] = kTold;
  core::LedgerRow here = row_of(50, 3);
  core::LedgerRow there = row_of(50, 20);
  core::Evidence evidence = core::evidence_of(here.verdict);
  evidence.competing_place =
      core::CompetingPlaceEvidence{.frame = core::FrameId(20), .num_inliers = 90};
  here.verdict = verifier_.decide(here.candidate, evidence, {});
  ASSERT_EQ(core::stage_of(here.verdict), "competing");
  waiting_.add({here, there});
  map_.closed = {core::CandidateId(7)};
  EXPECT_TRUE(asked_again().empty()) << "both are still possible";
  map_.closed = {core::CandidateId(8)};
  map_.odometry[core::FrameId(20)] = kContradicted;
  const auto decided = asked_again();
  ASSERT_EQ(decided.size(), 1U);
  EXPECT_TRUE(core::is_loop(decided[0].verdict));
  EXPECT_EQ(decided[0].candidate.match, core::FrameId(3));
}

TEST_F(Waiting, EachIsAskedOncePerChangeAndSoManyAtATime) {
  const int num_each = verifier_.config().asked_again_per_keyframe;
  std::vector<core::LedgerRow> rows;
  for (int i = 0; i < 2 * num_each + 3; ++i) {
    map_.odometry[core::FrameId(static_cast<std::uint64_t>(i))] = kUncertain;
    rows.push_back(row_of(100, i));
  }
  waiting_.add(rows);
  map_.closed = {core::CandidateId(7)};
  for (auto& [match, odometry] : map_.odometry) odometry = kTold;
  EXPECT_EQ(std::ssize(asked_again()), num_each);
  EXPECT_EQ(std::ssize(asked_again()), num_each);
  EXPECT_EQ(std::ssize(asked_again()), 3);
  EXPECT_TRUE(asked_again().empty());
}

TEST_F(Waiting, AllAreAskedAtTheEnd) {
  std::vector<core::LedgerRow> rows;
  for (int i = 0; i < 3 * verifier_.config().asked_again_per_keyframe; ++i) {
    map_.odometry[core::FrameId(static_cast<std::uint64_t>(i))] = kUncertain;
    rows.push_back(row_of(100, i));
  }
  waiting_.add(rows);
  map_.closed = {core::CandidateId(7)};
  for (auto& [match, odometry] : map_.odometry) odometry = kTold;
  EXPECT_EQ(waiting_.ask_again(map_, waiting_.size()).size(), rows.size());
  EXPECT_EQ(waiting_.size(), 0);
}

TEST_F(Waiting, ARelocalizationDoesNotWait) {
  map_.odometry[core::FrameId(3)] = kUncertain;
  core::LedgerRow row = row_of(50, 3);
  row.candidate.origin = core::Origin::kRelocalization;
  waiting_.add({row});
  map_.closed = {core::CandidateId(7)};
  map_.odometry[core::FrameId(3)] = kTold;
  EXPECT_TRUE(asked_again().empty());
}

}  // namespace
}  // namespace samewhere::verify
