#include <cmath>
#include <cstdlib>
#include <limits>
#include <set>
#include <sstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/random.hpp>
#include <samewhere/report/loops.hpp>
#include <samewhere/report/test_record.hpp>

namespace samewhere::report {
namespace {

using Json = nlohmann::json;

Json parsed(const core::Ledger& ledger) { return Json::parse(loops_json(ledger)); }

TEST(LedgerRowJson, IsAnEntryOnOneLineThatNamesALaterSession) {
  core::LedgerRow row = sample_ledger().front();
  const std::string text = ledger_row_json(row);
  EXPECT_EQ(text.find('\n'), std::string::npos);
  EXPECT_EQ(Json::parse(text), parsed({row}).at("candidates").at(0));
  row.candidate.query = core::FrameId(7, 2);
  EXPECT_EQ(Json::parse(ledger_row_json(row)).at("query_session"), 2);
  EXPECT_EQ(Json::parse(ledger_row_json(row)).at("match_session"), 0);
}

TEST(LoopsJson, FollowsTheSchema) {
  const Json document = parsed(sample_ledger());
  EXPECT_EQ(document.at("version"), 2);
  ASSERT_EQ(document.at("candidates").size(), 35u);
  const std::set<std::string> keys{"query",  "match",  "verdict",         "stage",
                                   "reason", "scores", "match_from_query"};
  for (const Json& entry : document.at("candidates")) {
    std::set<std::string> found;
    for (const auto& [key, value] : entry.items()) found.insert(key);
    EXPECT_EQ(found, keys);
    EXPECT_TRUE(entry.at("query").is_number_unsigned());
    EXPECT_TRUE(entry.at("match").is_number_unsigned());
    EXPECT_TRUE(entry.at("reason").is_string());
    for (const auto& [name, score] : entry.at("scores").items())
      EXPECT_TRUE(score.is_number() || score.is_null()) << name;
    const Json& pose = entry.at("match_from_query");
    EXPECT_TRUE(pose.is_null() || pose.size() == 7u);
  }
}

TEST(LoopsJson, ALoopSaysAllThatWasMeasured) {
  const Json entry = parsed({loop_row(candidate(0, 812, 40, 0.75), 80)}).at("candidates").at(0);
  EXPECT_EQ(entry.at("query"), 812);
  EXPECT_EQ(entry.at("match"), 40);
  EXPECT_EQ(entry.at("verdict"), "LOOP");
  EXPECT_EQ(entry.at("stage"), "accepted");
  EXPECT_EQ(entry.at("scores"), Json({{"similarity", 0.75},
                                      {"num_matches", 160},
                                      {"num_inliers", 80},
                                      {"inlier_ratio", 0.5},
                                      {"spread_ratio", 0.25},
                                      {"overlap_ratio", 0.75},
                                      {"reprojection_rmse_px", 1.25},
                                      {"correction_m", 0.4},
                                      {"correction_rad", 0.02},
                                      {"mahalanobis_squared", 3.5}}));
  const std::vector<double> pose = entry.at("match_from_query");
  const std::vector<double> expected{0.1, 0.0, 0.3, 0.0, std::sin(0.05), 0.0, std::cos(0.05)};
  for (std::size_t i = 0; i < 7; ++i) EXPECT_NEAR(pose[i], expected[i], 1e-12) << i;
}

TEST(LoopsJson, ARefusedCandidateSaysWhereAndWhy) {
  const Json entry = parsed({refused_row(candidate(0, 9, 1, 0.72), core::Refusal::kSimilarity,
                                         evidence(0.72, 0, 0), "too low")})
                         .at("candidates")
                         .at(0);
  EXPECT_EQ(entry.at("verdict"), "NOT");
  EXPECT_EQ(entry.at("stage"), "similarity");
  EXPECT_EQ(entry.at("reason"), "too low");
  EXPECT_EQ(entry.at("scores"), Json({{"similarity", 0.72}}));
  EXPECT_TRUE(entry.at("match_from_query").is_null());
}

TEST(LoopsJson, ScoresOfAGeometryThatWasNotFoundAreNull) {
  core::Evidence none = evidence(0.72, 30, 0);
  none.geometry = core::GeometryEvidence{.num_matches = 30};
  const Json entry =
      parsed({refused_row(candidate(0, 9, 1, 0.72), core::Refusal::kInliers, none, "none")})
          .at("candidates")
          .at(0);
  EXPECT_EQ(entry.at("scores"), Json({{"similarity", 0.72},
                                      {"num_matches", 30},
                                      {"num_inliers", 0},
                                      {"inlier_ratio", nullptr},
                                      {"spread_ratio", nullptr},
                                      {"overlap_ratio", nullptr},
                                      {"reprojection_rmse_px", nullptr}}));
}

TEST(LoopsJson, InliersAreOfTheMatchesOfTheSameStage) {
  core::LedgerRow row = loop_row(candidate(0, 9, 1, 0.75), 80);
  core::GeometryEvidence& geometry = *std::get<core::LoopClosure>(row.verdict).evidence.geometry;
  geometry.num_matches = 60;
  geometry.num_guided_matches = 110;
  const Json scores = parsed({row}).at("candidates").at(0).at("scores");
  EXPECT_EQ(scores.at("num_matches"), 110);
  EXPECT_EQ(scores.at("num_first_matches"), 60);
  EXPECT_EQ(scores.at("num_inliers"), 80);
}

TEST(LoopsJson, TheLastVerdictWins) {
  const Json candidates = parsed(sample_ledger()).at("candidates");
  EXPECT_EQ(candidates.at(30).at("query"), 300);
  EXPECT_EQ(candidates.at(30).at("verdict"), "AMBIGUOUS");
}

TEST(LoopsJson, AFreeScaleIsAScore) {
  core::LedgerRow row = loop_row(candidate(0, 9, 1, 0.8), 40);
  auto& loop = std::get<core::LoopClosure>(row.verdict);
  loop.scale_is_free = true;
  loop.match_from_query->scale = 1.5;
  EXPECT_EQ(parsed({row}).at("candidates").at(0).at("scores").at("scale"), 1.5);
}

TEST(LoopsJson, NoScoreThatIsNoNumberGetsIn) {
  core::LedgerRow row = loop_row(candidate(0, 9, 1, std::nan("")), 40);
  auto& loop = std::get<core::LoopClosure>(row.verdict);
  loop.evidence.geometry->reprojection_rmse_px = std::numeric_limits<double>::infinity();
  loop.match_from_query->translation.x() = std::nan("");
  const Json entry = parsed({row}).at("candidates").at(0);
  EXPECT_FALSE(entry.at("scores").contains("similarity"));
  EXPECT_FALSE(entry.at("scores").contains("reprojection_rmse_px"));
  EXPECT_TRUE(entry.at("match_from_query").is_null());
  for (const Json& score : entry.at("scores")) EXPECT_TRUE(std::isfinite(score.get<double>()));
}

TEST(LoopsJson, AReasonThatIsNoUtf8DoesNotCostTheFile) {
  const core::LedgerRow row = refused_row(candidate(0, 9, 1, 0.7), core::Refusal::kMatches,
                                          evidence(0.7, 3, 0), "frame \xff\xfe.png");
  EXPECT_EQ(parsed({row}).at("candidates").size(), 1u);
}

TEST(LoopsJson, OfNothingIsAnEmptyList) {
  EXPECT_EQ(parsed({}), Json({{"version", 2}, {"candidates", Json::array()}}));
}

TEST(LoopsJson, IsTheSameForTheSameLedger) {
  EXPECT_EQ(loops_json(sample_ledger()), loops_json(sample_ledger()));
}

TEST(PairsText, ReadsBackToTheSameBits) {
  std::vector<ScoredPair> pairs;
  core::Random random(4);
  for (std::uint64_t i = 0; i < 100; ++i)
    pairs.push_back({core::FrameId(2 * i), core::FrameId(i), random.gaussian() / 3.0});
  std::istringstream lines(pairs_text(pairs));
  for (const ScoredPair& pair : pairs) {
    std::uint64_t query = 0;
    std::uint64_t match = 0;
    std::string score;
    ASSERT_TRUE(lines >> query >> match >> score);
    EXPECT_EQ(query, pair.query.index());
    EXPECT_EQ(match, pair.match.index());
    EXPECT_EQ(std::strtod(score.c_str(), nullptr), pair.score);
  }
  EXPECT_EQ(pairs_text({}), "");
  EXPECT_THROW(pairs_text({{core::FrameId(1), core::FrameId(0), std::nan("")}}),
               core::ContractError);
}

}  // namespace
}  // namespace samewhere::report
