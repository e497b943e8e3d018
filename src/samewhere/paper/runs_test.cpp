#include <gtest/gtest.h>

#include <samewhere/paper/runs.hpp>
#include <samewhere/paper/test_described.hpp>

namespace samewhere::paper {
namespace {

constexpr int kManyDraws = 500;  // enough to draw every queue

PaperBlock block_of(const pipeline::Config& config) {
  const DescribedRecording recording = second_lap();
  const PaperPlan plan{.num_draws = {1, kManyDraws}, .num_seeds = 3};
  const auto block = run_paper_plan(recording, recording.by_describer.front(), config, plan);
  EXPECT_TRUE(block.has_value());
  return *block;
}

TEST(PaperRuns, OfSixViewsAreWhatTheHandCounts) {
  const PaperBlock block = block_of(small_store());
  ASSERT_EQ(block.runs.size(), 8u);
  const PaperRun& exact = block.runs.back();
  EXPECT_EQ(exact.search, retrieve::Search::kExact);
  EXPECT_NEAR(exact.result.auc, kSecondLapAuc, 1e-12);
  EXPECT_EQ(exact.result.num_with_loop, 3);
  EXPECT_EQ(exact.loops.counts.num_right, 2);
  EXPECT_EQ(exact.loops.counts.num_wrong, 1);
  EXPECT_EQ(exact.loops.num_impostors, 1);
  EXPECT_EQ(exact.search_ms.size(), 6u);
  EXPECT_EQ(exact.exact_similarity_ms.size(), 6u);
}

TEST(PaperRuns, ManyDrawsFindAllAndOneDrawDoesNot) {
  const PaperBlock block = block_of(small_store());
  double least = 1.0;
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(block.runs[i].num_draws, 1);
    EXPECT_EQ(block.runs[i].seed, static_cast<int>(i));
    least = std::min(least, block.runs[i].result.max_recall);
    EXPECT_EQ(block.runs[i + 3].num_draws, kManyDraws);
    EXPECT_NEAR(block.runs[i + 3].result.auc, kSecondLapAuc, 1e-12) << "seed " << i;
  }
  EXPECT_LT(least, 2.0 / 3.0);
}

TEST(PaperRuns, EveryQueueIsTheLimitOfTheSamplingAndExactIsNot) {
  // with a threshold that only the first revisit exceeds
  pipeline::Config config = small_store();
  config.retrieve.min_similarity = 0.99;
  const PaperBlock block = block_of(config);
  const PaperRun& all = block.runs[6];
  EXPECT_EQ(all.search, retrieve::Search::kEveryQueue);
  EXPECT_NEAR(all.result.max_recall, 1.0 / 3.0, 1e-12);
  for (std::size_t i = 3; i < 6; ++i)
    EXPECT_EQ(block.runs[i].result.auc, all.result.auc) << "seed " << i - 3;
  EXPECT_GT(block.runs[7].result.max_recall, all.result.max_recall) << "exact has no threshold";
}

TEST(PaperRuns, AfterALoopDetectionPauses) {
  pipeline::Config config = small_store();
  config.verify.pause_frames = 1;
  const PaperRun exact = block_of(config).runs.back();
  // the wrong one comes one frame after the first
  EXPECT_EQ(exact.loops.counts.num_right, 2);
  EXPECT_EQ(exact.loops.counts.num_wrong, 0);
  EXPECT_EQ(exact.loops.num_impostors, 0);
  EXPECT_NEAR(exact.result.auc, kSecondLapAuc, 1e-12) << "the curve knows no pause";
  config.verify.pause_frames = 10;
  EXPECT_EQ(block_of(config).runs.back().loops.counts.num_right, 1);
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
