#include <gtest/gtest.h>

#include <samewhere/paper/runs.hpp>
#include <samewhere/paper/test_described.hpp>

namespace samewhere::paper {
namespace {

constexpr int kManyDraws = 500;  // enough to draw every queue

std::vector<RecognitionRow> rows_with(const pipeline::Config& config) {
  const DescribedRecording recording = second_lap();
  const PaperPlan plan{.num_draws = {1, kManyDraws}, .num_seeds = 3};
  const auto rows = run_searches(recording, recording.by_describer.front(), config, plan);
  EXPECT_TRUE(rows.has_value());
  return *rows;
}

TEST(PaperRuns, OfSixViewsAreWhatTheHandCounts) {
  const auto rows = rows_with(small_store());
  ASSERT_EQ(rows.size(), 8u);
  const RecognitionRow& exact = rows.back();
  EXPECT_EQ(exact.search, SearchKind::kExact);
  EXPECT_EQ(exact.method, "by hand");
  EXPECT_NEAR(exact.result.auc, kSecondLapAuc, 1e-12);
  EXPECT_EQ(exact.result.num_with_loop, 3);
  EXPECT_EQ(exact.loops.num_true, 2);
  EXPECT_EQ(exact.loops.num_false, 1);
  EXPECT_EQ(exact.loops.num_aliased, 1);
  EXPECT_EQ(exact.ms.at("search").count, 6);
  EXPECT_EQ(exact.ms.at(kTogether).count, 3) << "of the frames whose description was timed";
  EXPECT_GT(exact.ms.at(kTogether).median_ms, 2.0) << "description alone takes two";
}

TEST(PaperRuns, ManyDrawsFindAllAndOneDrawDoesNot) {
  const auto rows = rows_with(small_store());
  double least = 1.0;
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(rows[i].num_draws, 1);
    EXPECT_EQ(rows[i].seed, static_cast<int>(i));
    least = std::min(least, rows[i].result.max_recall);
    EXPECT_EQ(rows[i + 3].num_draws, kManyDraws);
    EXPECT_NEAR(rows[i + 3].result.auc, kSecondLapAuc, 1e-12) << "seed " << i;
  }
  EXPECT_LT(least, 2.0 / 3.0);
}

TEST(PaperRuns, EveryQueueIsTheLimitOfTheSamplingAndExactIsNot) {
  // with a threshold that only the first revisit exceeds
  pipeline::Config config = small_store();
  config.retrieve.min_similarity = 0.99;
  const auto rows = rows_with(config);
  const RecognitionRow& all = rows[6];
  EXPECT_EQ(all.search, SearchKind::kEveryQueue);
  EXPECT_NEAR(all.result.max_recall, 1.0 / 3.0, 1e-12);
  for (std::size_t i = 3; i < 6; ++i)
    EXPECT_EQ(rows[i].result.auc, all.result.auc) << "seed " << i - 3;
  EXPECT_GT(rows[7].result.max_recall, all.result.max_recall) << "exact has no threshold";
}

TEST(PaperRuns, AfterALoopDetectionPauses) {
  pipeline::Config config = small_store();
  config.verify.pause_frames = 1;
  const RecognitionRow exact = rows_with(config).back();
  // the wrong one comes one frame after the first
  EXPECT_EQ(exact.loops.num_true, 2);
  EXPECT_EQ(exact.loops.num_false, 0);
  EXPECT_EQ(exact.loops.num_aliased, 0);
  EXPECT_NEAR(exact.result.auc, kSecondLapAuc, 1e-12) << "the curve knows no pause";
  config.verify.pause_frames = 10;
  EXPECT_EQ(rows_with(config).back().loops.num_true, 1);
}

TEST(PaperRuns, ALoopIsMoreSimilarThanTheThreshold) {
  pipeline::Config config = small_store();
  const std::vector<evaluate::Match> matches{{3, 0, 0.7}, {5, 1, 0.70001}};
  config.verify.min_similarity = 0.7;
  const auto accepted = accepted_with_pause(matches, config.verify);
  ASSERT_EQ(accepted.size(), 1u);
  EXPECT_EQ(accepted.front().query, 5);
}

}  // namespace
}  // namespace samewhere::paper
