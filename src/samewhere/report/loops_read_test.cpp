#include <limits>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/report/funnel.hpp>
#include <samewhere/report/loops.hpp>
#include <samewhere/report/loops_read.hpp>
#include <samewhere/report/test_record.hpp>

namespace samewhere::report {
namespace {

using ::testing::HasSubstr;

class LoopsRead : public testing::Test {
 protected:
  ~LoopsRead() override { std::filesystem::remove(path_); }

  core::Ledger read(const std::string& text) const {
    core::write_file(path_, text);
    return read_loops_json(path_);
  }

  std::string complaint(const std::string& text) const {
    try {
      read(text);
    } catch (const core::InputError& error) {
      return error.what();
    }
    return "none";
  }

  // of each process its own: tests may run at once
  std::filesystem::path path_ =
      testing::TempDir() + "loops_read_test_" + std::to_string(getpid()) + ".json";
};

TEST_F(LoopsRead, WhatWasWrittenIsWrittenAgain) {
  const core::Ledger ledger = sample_ledger();
  const std::string text = loops_json(ledger);
  const core::Ledger found = read(text);
  EXPECT_EQ(loops_json(found), text);
  ASSERT_EQ(found.size(), final_rows(ledger).size());
  EXPECT_EQ(found[34].candidate.id, core::CandidateId(34)) << "by position";
}

TEST_F(LoopsRead, BothStagesOfMatchesAreReadBackAndNullIsNotMeasured) {
  core::Evidence guided = evidence(0.8, 60, 50);
  guided.geometry->num_guided_matches = 110;
  core::Evidence none = evidence(0.8, 30, 0);
  none.geometry = core::GeometryEvidence{.num_matches = 30};
  const std::string text = loops_json(
      {refused_row(candidate(0, 9, 2, 0.8), core::Refusal::kSpread, guided, "one corner"),
       refused_row(candidate(1, 9, 3, 0.8), core::Refusal::kInliers, none, "none")});
  ASSERT_THAT(text, HasSubstr("null"));
  const core::Ledger found = read(text);
  EXPECT_EQ(loops_json(found), text);
  EXPECT_EQ(core::evidence_of(found.at(0).verdict).geometry->num_matches, 60);
  EXPECT_EQ(core::evidence_of(found.at(0).verdict).geometry->num_guided_matches, 110);
  EXPECT_EQ(core::evidence_of(found.at(1).verdict).geometry->reprojection_rmse_px, 0.0);
}

TEST_F(LoopsRead, AMatchOfAnEarlierSessionStaysOne) {
  core::LedgerRow row = refused_row(candidate(0, 9, 2, 0.8), core::Refusal::kMatches,
                                    evidence(0.8, 10, 0), "too few");
  row.candidate.query = core::FrameId(9, 3);
  const core::Ledger found = read(loops_json({row}));
  EXPECT_EQ(found.at(0).candidate.query, core::FrameId(9, 3));
  EXPECT_EQ(found.at(0).candidate.match, core::FrameId(2, 0));
  EXPECT_EQ(name_of_match(found.at(0).candidate), "2 of session 0");
}

TEST_F(LoopsRead, APoseThatOneViewAloneFindsStaysApartWithoutEnd) {
  core::LedgerRow row = refused_row(candidate(0, 9, 2, 0.8), core::Refusal::kConsistency,
                                    evidence(0.8, 100, 50), "only one view");
  std::get<core::Rejection>(row.verdict).evidence.geometry->pose_difference_m =
      std::numeric_limits<double>::infinity();
  const core::Ledger found = read(loops_json({row}));
  EXPECT_EQ(core::evidence_of(found.at(0).verdict).geometry->pose_difference_m,
            std::numeric_limits<double>::infinity());
}

TEST_F(LoopsRead, SequenceAndOriginAreReadBack) {
  core::Evidence pending = evidence(0.8, 100, 50);
  pending.sequence =
      core::SequenceEvidence{.query_view = 9, .match_view = 2, .num_views = 5, .num_inliers = 200};
  core::Candidate about = candidate(0, 9, 2, 0.8);
  about.origin = core::Origin::kPredicted;
  const core::Ledger found = read(loops_json(
      {{about, core::Ambiguous{.candidate = about.id, .evidence = pending, .reason = "so far"}}}));
  EXPECT_EQ(core::reason_of(found.at(0).verdict), "so far");
  const auto& sequence = core::evidence_of(found.at(0).verdict).sequence;
  ASSERT_TRUE(sequence);
  EXPECT_EQ(sequence->query_view, 9);
  EXPECT_EQ(sequence->match_view, 2);
  EXPECT_EQ(sequence->num_views, 5);
  EXPECT_EQ(sequence->num_inliers, 200);
  EXPECT_FALSE(sequence->is_over);
  EXPECT_EQ(found.at(0).candidate.origin, core::Origin::kPredicted);
  EXPECT_EQ(core::evidence_of(found.at(0).verdict).geometry->overlap_ratio, 0.75);
}

TEST_F(LoopsRead, WhatOdometrySaysIsReadBack) {
  core::Evidence by_odometry = evidence(0.8, 100, 50);
  by_odometry.odometry = core::OdometryEvidence{.correction_m = 0.5,
                                                .correction_rad = 0.02,
                                                .mahalanobis_squared = 3.5,
                                                .sigma_m = 0.75,
                                                .look_alike_gain = 20.0,
                                                .look_alike_gain_with_loops = 30.0,
                                                .mahalanobis_squared_with_loops = 2.5,
                                                .variance_factor = 0.25};
  const core::Candidate about = candidate(0, 9, 2, 0.8);
  const std::string text =
      loops_json({{about, core::LoopClosure{.candidate = about.id, .evidence = by_odometry}}});
  const core::Ledger found = read(text);
  EXPECT_EQ(loops_json(found), text);
  const auto odometry = *core::evidence_of(found.at(0).verdict).odometry;
  EXPECT_EQ(odometry.sigma_m, 0.75);
  EXPECT_EQ(odometry.look_alike_gain, 20.0);
  EXPECT_EQ(odometry.look_alike_gain_with_loops, 30.0);
  EXPECT_EQ(odometry.mahalanobis_squared_with_loops, 2.5);
  EXPECT_EQ(odometry.variance_factor, 0.25);
}

TEST_F(LoopsRead, ACompetingLoopIsReadBack) {
  core::Evidence evidence_of_both = evidence(0.8, 100, 50);
  evidence_of_both.competing_loop = core::CompetingLoopEvidence{
      .frame = core::FrameId(3), .apart_m = 1.8, .apart_rad = 0.02, .mahalanobis_squared = 250.0};
  const core::Candidate about = candidate(0, 9, 2, 0.8);
  const std::string text = loops_json({{about, core::Ambiguous{.candidate = about.id,
                                                               .evidence = evidence_of_both,
                                                               .stage = core::Refusal::kCompeting,
                                                               .reason = "two places"}}});
  const core::Ledger found = read(text);
  EXPECT_EQ(loops_json(found), text);
  EXPECT_EQ(core::stage_of(found.at(0).verdict), "competing");
  EXPECT_EQ(core::evidence_of(found.at(0).verdict).competing_loop->mahalanobis_squared, 250.0);
}

TEST_F(LoopsRead, ALoopThatOverrulesOthersIsReadBackWithItsGain) {
  core::Evidence evidence_of_both = evidence(0.8, 100, 50);
  evidence_of_both.competing_loop = core::CompetingLoopEvidence{.frame = core::FrameId(3),
                                                                .apart_m = 1.8,
                                                                .apart_rad = 0.02,
                                                                .mahalanobis_squared = 250.0,
                                                                .first_loop = core::CandidateId(4),
                                                                .gain = 9.5};
  const core::Candidate about = candidate(0, 9, 2, 0.8);
  core::LoopClosure loop{.candidate = about.id, .evidence = evidence_of_both};
  loop.overruled = core::CandidateId(4);
  const std::string text = loops_json({{about, loop}});
  const core::Ledger found = read(text);
  EXPECT_EQ(loops_json(found), text);
  const auto& read_back = std::get<core::LoopClosure>(found.at(0).verdict);
  EXPECT_EQ(read_back.overruled, core::CandidateId(4));
  EXPECT_EQ(read_back.evidence.competing_loop->first_loop, core::CandidateId(4));
  EXPECT_EQ(read_back.evidence.competing_loop->gain, 9.5);
  EXPECT_THAT(core::reason_of(found.at(0).verdict),
              HasSubstr("the place of frame 3 at 1.80 m: odometry supports"));
}

TEST_F(LoopsRead, ACompetingPlaceIsReadBack) {
  core::Evidence evidence_of_both = evidence(0.8, 100, 50);
  evidence_of_both.competing_place = core::CompetingPlaceEvidence{
      .frame = core::FrameId(3), .num_inliers = 49, .apart_m = 5.9, .apart_rad = 0.02};
  const core::Candidate about = candidate(0, 9, 2, 0.8);
  const std::string text =
      loops_json({{about, core::Ambiguous{about.id, evidence_of_both, core::Refusal::kCompeting,
                                          "two places"}}});
  const core::Ledger found = read(text);
  EXPECT_EQ(loops_json(found), text);
  const auto& other = core::evidence_of(found.at(0).verdict).competing_place;
  ASSERT_TRUE(other);
  EXPECT_EQ(other->frame, core::FrameId(3));
  EXPECT_EQ(other->num_inliers, 49);
  EXPECT_EQ(other->apart_m, 5.9);
}

TEST_F(LoopsRead, Version1IsReadUnderTheNamesOfToday) {
  const auto ledger_of = [&](const std::string& flag, const std::string& stage,
                             const std::string& scores) {
    return read(
        R"({"version": 1, "candidates": [{"query": 9, "match": 2, "verdict": "AMBIGUOUS", )" +
        flag + R"("stage": ")" + stage + R"(", "reason": "", "scores": {"similarity": 0.8)" +
        scores + R"(}, "match_from_query": null}]})");
  };
  const auto origin_of = [&](const std::string& flag) {
    return ledger_of(flag, "sequence", "").at(0).candidate.origin;
  };
  EXPECT_EQ(origin_of(""), core::Origin::kRetrieved);
  EXPECT_EQ(origin_of(R"("is_foretold": true, )"), core::Origin::kPredicted);
  EXPECT_EQ(origin_of(R"("is_by_features": true, )"), core::Origin::kVisualWords);
  EXPECT_EQ(origin_of(R"("is_lost": true, "is_by_features": true, )"),
            core::Origin::kRelocalization);
  const auto row = ledger_of("", "rival",
                             R"(, "rival": 3, "rival_mahalanobis_squared": 250, )"
                             R"("rival_first_loop": 4, "rival_gain": 9.5, )"
                             R"("other_place": 5, "other_place_inliers": 49, "num_matches": 60, )"
                             R"("num_inliers": 50, "disagreement_m": 0.25)")
                       .at(0);
  EXPECT_EQ(core::stage_of(row.verdict), "competing");
  const core::Evidence& evidence = core::evidence_of(row.verdict);
  EXPECT_EQ(evidence.competing_loop->mahalanobis_squared, 250.0);
  EXPECT_EQ(evidence.competing_loop->first_loop, core::CandidateId(4));
  EXPECT_EQ(evidence.competing_loop->gain, 9.5);
  EXPECT_EQ(evidence.competing_place->num_inliers, 49);
  EXPECT_EQ(evidence.geometry->pose_difference_m, 0.25);
  EXPECT_EQ(core::stage_of(ledger_of("", "agreement", "").at(0).verdict), "consistency");
}

TEST_F(LoopsRead, AnUnknownOriginIsRefused) {
  EXPECT_THAT(complaint(R"({"version": 2, "candidates": [{"query": 9, "match": 2, "origin": "found",
                            "verdict": "NOT", "scores": {"similarity": 0.8}}]})"),
              HasSubstr("\"origin\" is \"found\"; expected"));
}

TEST_F(LoopsRead, WhatIsNoCandidateTakesNoMemory) {
  const auto with = [](const std::string& entries) {
    return R"({"version": 1, "candidates": [)" + entries + "]}";
  };
  std::string many = "0";
  for (int i = 0; i < 2000; ++i) many += ",0";
  EXPECT_THAT(complaint(with(R"({"query": [)" + many + "]}")),
              HasSubstr("candidate 0: has more than 1000 values"));
  EXPECT_THAT(complaint(with(std::string(1'000'000, '['))), HasSubstr("candidate 0: is no object"));
  EXPECT_THAT(complaint(with(R"({"query": )" + std::string(1'000'000, '['))),
              HasSubstr("candidate 0: has more than 1000 values"));
  EXPECT_THAT(complaint(with("7")), HasSubstr("candidate 0: is no object"));
  EXPECT_THAT(complaint(R"({"version": 1, "candidates": {"a": {}}})"), HasSubstr("is no list"));
  EXPECT_THAT(complaint(R"({"version": 1})"), HasSubstr("candidates"));
  EXPECT_THAT(complaint("[]"), HasSubstr(path_.string()));
  EXPECT_TRUE(read(R"({"more": [[1], {"version": 3}], "candidates": [], "version": 1})").empty());
}

TEST_F(LoopsRead, AFileThatIsNoneIsRefusedInOneLine) {
  const std::string text = loops_json(sample_ledger());
  for (const std::size_t length : {std::size_t{0}, text.size() / 2, text.size() - 3})
    EXPECT_THAT(complaint(text.substr(0, length)), HasSubstr(path_.string() + ": "));
  EXPECT_THAT(complaint(R"({"version": 3, "candidates": []})"),
              HasSubstr("version 3; expected 1 or 2"));
  EXPECT_THAT(complaint(R"({"version": 1, "candidates": [{"query": 1}]})"),
              HasSubstr("candidate 0: "));
  EXPECT_THAT(complaint(R"({"version": 1, "candidates": [{"query": 1, "match": 0, "verdict": "NOT",
      "stage": "mood", "reason": "", "scores": {"similarity": 0.5}, "match_from_query": null}]})"),
              HasSubstr("candidate 0: \"stage\" is \"mood\""));
  for (const char* number : {"-1", "281474976710656", "18446744073709551615"})
    EXPECT_THAT(complaint(std::string(R"({"version": 1, "candidates": [{"query": )") + number +
                          R"(, "match": 0, "verdict": "NOT", "stage": "similarity", "reason": "",
                         "scores": {"similarity": 0.5}, "match_from_query": null}]})"),
                HasSubstr("candidate 0: found "));
  EXPECT_THAT(complaint(R"({"version": 1, "candidates": [{"query": "one", "match": 0,
      "scores": {"similarity": 0.5}}]})"),
              HasSubstr("candidate 0: "));
}

}  // namespace
}  // namespace samewhere::report
