#include <algorithm>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include <samewhere/run/run_metrics.hpp>

namespace samewhere::run {
namespace {

core::Rigid3 at_x(double x_m) {
  core::Rigid3 pose;
  pose.translation.x() = x_m;
  return pose;
}

// Along a corridor, one metre a second, and after ten seconds at its start again. Tracking is lost
// in frames 10 and 11, and relocalized in 12; a copy of the corridor begins at frame 5.
class Relocalizations : public testing::Test {
 protected:
  Relocalizations() {
    for (int i = 0; i < kNumFrames; ++i) {
      stamp_of_[core::FrameId(static_cast<std::uint64_t>(i))] = i;
      truth_.trajectory.push_back({static_cast<double>(i), at_x(i % 10)});
    }
    truth_.revisits = {{10, 15}};
    findings_.num_frames = kNumFrames;
  }

  void recognised(int query, int match, double match_x_of_query_m) {
    core::LoopClosure loop{.candidate = core::CandidateId(ledger_.size())};
    loop.match_from_query = core::Sim3::from_rigid(at_x(match_x_of_query_m));
    ledger_.push_back({{.id = loop.candidate,
                        .query = core::FrameId(static_cast<std::uint64_t>(query)),
                        .match = core::FrameId(static_cast<std::uint64_t>(match)),
                        .origin = core::Origin::kRelocalization},
                       loop});
  }

  // With this estimated position from frame 12 on.
  SlamEvaluation evaluated_if_found_at(double x_m) {
    for (int i = 0; i < kNumFrames; ++i) {
      if (i < 10) findings_.trajectory.push_back({static_cast<double>(i), at_x(i)});
      if (i >= 12) findings_.trajectory.push_back({static_cast<double>(i), at_x(x_m + i - 12)});
    }
    add_loops(ledger_, stamp_of_, findings_);
    add_relocalized(ledger_, stamp_of_, {core::FrameId(12)}, findings_);
    return evaluate_slam(findings_, truth_);
  }

  static constexpr int kNumFrames = 16;
  core::Ledger ledger_;
  StampOf stamp_of_;
  SlamFindings findings_;
  core::Truth truth_;
};

std::string figure(const SlamEvaluation& evaluation, const std::string& name) {
  const auto figures = figures_of(evaluation);
  const auto it = std::find_if(figures.begin(), figures.end(),
                               [&](const report::Figure& each) { return each.name == name; });
  return it == figures.end() ? "" : it->value;
}

constexpr const char* kFound = "relocalizations: correct / wrong / unknown";
constexpr const char* kRejoined = "revisits closed or relocalized";

TEST_F(Relocalizations, InTheRightPlaceWhichIsNoLoop) {
  recognised(12, 5, 2.0);  // accepted for one view, but not the final place
  recognised(12, 0, 2.0);
  const SlamEvaluation evaluation = evaluated_if_found_at(2.0);
  EXPECT_EQ(figure(evaluation, kFound), "1 / 0 / 0");
  EXPECT_EQ(figure(evaluation, kRejoined), "1 of 1");
  EXPECT_EQ(figure(evaluation, "revisits closed"), "0 of 1");
  EXPECT_EQ(evaluation.loops.num_true, 0);
}

TEST_F(Relocalizations, InItsCopyWhichIsWrong) {
  recognised(12, 5, 2.0);
  recognised(12, 0, 2.0);
  const SlamEvaluation evaluation = evaluated_if_found_at(7.0);
  EXPECT_EQ(figure(evaluation, kFound), "0 / 1 / 0");
  EXPECT_EQ(figure(evaluation, kRejoined), "0 of 1");
}

TEST_F(Relocalizations, OfAPlaceThatTheEvidenceLeavesAmbiguousIsCountedToo) {
  recognised(12, 0, 2.0);
  core::LedgerRow& row = ledger_.back();
  core::Ambiguous ambiguous{.candidate = row.candidate.id, .stage = core::Refusal::kEvidence};
  ambiguous.evidence.geometry.emplace().match_from_query = core::Sim3::from_rigid(at_x(2.0));
  row.verdict = ambiguous;
  EXPECT_EQ(figure(evaluated_if_found_at(2.0), kFound), "1 / 0 / 0");
}

// The place was told of an earlier view, and this one only of the right one.
TEST_F(Relocalizations, ThePoseCountsAndNotTheVerdict) {
  recognised(12, 0, 2.0);
  const SlamEvaluation evaluation = evaluated_if_found_at(7.0);
  EXPECT_EQ(figure(evaluation, kFound), "0 / 1 / 0");
  EXPECT_EQ(figure(evaluation, kRejoined), "0 of 1");
}

TEST_F(Relocalizations, OfTwoVisitsTheEarlierIsJoined) {
  truth_.revisits = {{8, 15}};
  recognised(12, 9, -7.0);
  recognised(12, 0, 2.1);
  const SlamEvaluation evaluation = evaluated_if_found_at(2.0);
  EXPECT_EQ(figure(evaluation, kFound), "1 / 0 / 0");
  EXPECT_EQ(figure(evaluation, kRejoined), "1 of 1");
}

TEST_F(Relocalizations, WhatAFrameSaysThatIsStillLostIsNotAsked) {
  recognised(11, 0, 1.0);
  const SlamEvaluation evaluation = evaluated_if_found_at(2.0);
  EXPECT_EQ(figure(evaluation, kFound), "");
  EXPECT_EQ(evaluation.num_rejoined, 0);
}

// A relocalization in the place of the last pose joins no earlier visit.
TEST_F(Relocalizations, InTheSameVisitJoinsNothing) {
  truth_.revisits = {{0, 15}};
  recognised(12, 0, 2.0);
  const SlamEvaluation evaluation = evaluated_if_found_at(2.0);
  EXPECT_EQ(figure(evaluation, kFound), "1 / 0 / 0");
  EXPECT_EQ(figure(evaluation, kRejoined), "0 of 1");
}

}  // namespace
}  // namespace samewhere::run
