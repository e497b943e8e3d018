#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/random.hpp>
#include <samewhere/evaluate/precision_recall.hpp>

namespace samewhere::evaluate {
namespace {

// Rows of digits 0 different, 1 same, 2 near.
core::PlaceTruthMatrix matrix(const std::vector<std::string>& rows) {
  core::PlaceTruthMatrix truth;
  truth.num_frames = static_cast<int>(rows.size());
  for (const std::string& row : rows)
    for (const char digit : row) truth.values.push_back(static_cast<core::PlaceTruth>(digit - '0'));
  return truth;
}

// Frames 3, 4, 5 come back to 0, 1, 2; frame 5 also sees a bit of 1.
const core::PlaceTruthMatrix kSecondLap =
    matrix({"100000", "010000", "001000", "100100", "010010", "021001"});

TEST(PrecisionRecall, OfAKnownListIsKnown) {
  // true at the highest score, then false, then true
  const PrecisionRecall result =
      precision_recall(kSecondLap, {{3, 0, 0.9}, {4, 0, 0.8}, {5, 2, 0.7}}, 0);
  EXPECT_EQ(result.num_queries, 6);
  EXPECT_EQ(result.num_with_loop, 3);
  EXPECT_EQ(result.num_false, 1);
  ASSERT_EQ(result.curve.size(), 3u);
  EXPECT_NEAR(result.curve[1].precision, 0.5, 1e-12);
  EXPECT_NEAR(result.curve[2].precision, 2.0 / 3.0, 1e-12);
  EXPECT_NEAR(result.curve[2].score, 0.7, 1e-12);
  // 1/3 of recall at precision 1, then 1/3 between 1/2 and 2/3
  EXPECT_NEAR(result.auc, 1.0 / 3.0 + (0.5 + 2.0 / 3.0) / 6.0, 1e-12);
  EXPECT_NEAR(result.recall_at_full_precision, 1.0 / 3.0, 1e-12);
  EXPECT_NEAR(result.precision_at_recall_35, 2.0 / 3.0, 1e-12);
  EXPECT_EQ(result.precision_at_recall_70, 0.0);
  EXPECT_NEAR(result.max_recall, 2.0 / 3.0, 1e-12);
}

TEST(PrecisionRecall, OfAPerfectDetectorIsOne) {
  const PrecisionRecall result =
      precision_recall(kSecondLap, {{3, 0, 0.1}, {4, 1, 0.2}, {5, 2, 0.3}}, 0);
  EXPECT_NEAR(result.auc, 1.0, 1e-12);
  EXPECT_NEAR(result.recall_at_full_precision, 1.0, 1e-12);
  EXPECT_EQ(result.num_false, 0);
}

TEST(PrecisionRecall, EqualScoresAreAcceptedTogether) {
  const PrecisionRecall result = precision_recall(kSecondLap, {{3, 0, 0.5}, {4, 0, 0.5}}, 0);
  ASSERT_EQ(result.curve.size(), 1u);
  EXPECT_NEAR(result.curve[0].precision, 0.5, 1e-12);
  EXPECT_EQ(result.recall_at_full_precision, 0.0);
}

TEST(PrecisionRecall, ANearMatchCountsForNothingButItsQueryStaysMissed) {
  const PrecisionRecall result =
      precision_recall(kSecondLap, {{3, 0, 0.9}, {4, 1, 0.9}, {5, 1, 1.0}}, 0);
  EXPECT_EQ(result.num_false, 0);
  EXPECT_NEAR(result.max_recall, 2.0 / 3.0, 1e-12);
  EXPECT_NEAR(result.recall_at_full_precision, 2.0 / 3.0, 1e-12);
}

TEST(PrecisionRecall, TheWindowTakesRecentMatchesAndTheirLoopsAway) {
  const std::vector<Match> matches{{3, 0, 0.9}, {4, 1, 0.8}, {5, 2, 0.7}};
  EXPECT_EQ(precision_recall(kSecondLap, matches, 2).num_with_loop, 3);
  EXPECT_NEAR(precision_recall(kSecondLap, matches, 2).auc, 1.0, 1e-12);
  EXPECT_EQ(precision_recall(kSecondLap, matches, 3).num_with_loop, 0);
  EXPECT_TRUE(precision_recall(kSecondLap, matches, 3).curve.empty());
}

TEST(PrecisionRecall, OfNothingIsZero) {
  const PrecisionRecall silent = precision_recall(kSecondLap, {}, 0);
  EXPECT_EQ(silent.num_with_loop, 3);
  EXPECT_EQ(silent.auc, 0.0);
  const PrecisionRecall empty = precision_recall({}, {}, 0);
  EXPECT_EQ(empty.num_queries, 0);
  EXPECT_EQ(empty.auc, 0.0);
}

TEST(PrecisionRecall, OnlyTheOrderOfTheScoresMatters) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    core::Random random(seed);
    core::PlaceTruthMatrix truth{30, {}};
    for (int i = 0; i < 900; ++i)
      truth.values.push_back(static_cast<core::PlaceTruth>(random.index(3)));
    std::vector<Match> matches;
    for (int query = 29; query > 0; --query)
      matches.push_back({query, static_cast<int>(random.index(query)), random.uniform()});
    std::vector<Match> stretched = matches;
    for (Match& row : stretched) row.score = std::exp(5.0 * row.score) - 100.0;
    const PrecisionRecall result = precision_recall(truth, matches, 3);
    EXPECT_EQ(result.auc, precision_recall(truth, stretched, 3).auc);
    EXPECT_GE(result.auc, 0.0);
    EXPECT_LE(result.auc, 1.0);
    EXPECT_LE(result.recall_at_full_precision, result.max_recall);
    for (std::size_t i = 1; i < result.curve.size(); ++i)
      EXPECT_GE(result.curve[i].recall, result.curve[i - 1].recall);
  }
}

TEST(PrecisionRecall, RefusesRowsThatMakeNoSense) {
  EXPECT_THROW(precision_recall(kSecondLap, {{6, 0, 1.0}}, 0), core::InputError);
  EXPECT_THROW(precision_recall(kSecondLap, {{3, -1, 1.0}}, 0), core::InputError);
  EXPECT_THROW(precision_recall(kSecondLap, {{3, 0, 1.0}, {3, 1, 0.5}}, 0), core::InputError);
  EXPECT_THROW(precision_recall(kSecondLap, {{3, 0, std::nan("")}}, 0), core::InputError);
}

TEST(CountAccepted, SortsEveryRowIntoOneOfFour) {
  const AcceptedCounts counts = count_accepted(
      kSecondLap, {{3, 0, 1}, {4, 1, 1}, {4, 0, 1}, {5, 1, 1}, {5, 3, 1}, {5, 3, 1}}, 2);
  EXPECT_EQ(counts.num_true, 2);
  EXPECT_EQ(counts.num_false, 1);
  EXPECT_EQ(counts.num_near, 1);
  EXPECT_EQ(counts.num_recent, 2);
  EXPECT_THROW(count_accepted(kSecondLap, {{0, 6, 1}}, 2), core::InputError);
}

TEST(CountAccepted, AliasedPairsAreCountedOutsideOfTheWindow) {
  const std::vector<core::FramePair> pairs = {{3, 0}, {4, 0}, {5, 3}};
  EXPECT_EQ(count_accepted_aliased(pairs, {{3, 0, 1}, {4, 1, 1}, {4, 0, 1}, {5, 3, 1}}, 2), 2);
  EXPECT_EQ(count_accepted_aliased({}, {{3, 0, 1}}, 2), 0);
  EXPECT_TRUE(is_aliased_pair(pairs, 4, 0));
  EXPECT_TRUE(is_aliased_pair(pairs, 0, 4));
  EXPECT_FALSE(is_aliased_pair(pairs, 4, 3));
}

}  // namespace
}  // namespace samewhere::evaluate
