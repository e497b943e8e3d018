// Acceptance in the twin building: one and a bit laps through a corridor of look-alike doors.

#include <algorithm>

#include <gtest/gtest.h>
#include <opencv2/core/utility.hpp>

#include <samewhere/run/open_source.hpp>
#include <samewhere/run/run.hpp>
#include <samewhere/run/run_metrics.hpp>

namespace samewhere {
namespace {

// One test, because the run takes a minute or two.
TEST(Corridor, LookAlikeDoorsGiveNoFalseLoopAndTheTrueLoopCorrectsTheDrift) {
  cv::setNumThreads(1);
  pipeline::Config config;
  config.source = "twin:office-loop?seed=1";
  auto source = run::open_source(config);
  const core::Truth truth = source->truth();
  const report::RunRecord record = run::run_slam(std::move(source), config).record;
  const auto evaluation = run::evaluate_slam(run::findings_of(record, false), truth);

  EXPECT_EQ(evaluation.num_measured, evaluation.num_frames);
  EXPECT_EQ(evaluation.loops.num_false, 0);
  EXPECT_GT(evaluation.num_candidates, 100) << "zero wrong among none proves nothing";
  EXPECT_GE(evaluation.loops.num_true, 1);
  EXPECT_EQ(evaluation.loops.num_revisits, 1);
  EXPECT_EQ(evaluation.loops.num_closed, 1);
  ASSERT_TRUE(evaluation.ate && evaluation.odometry_ate);
  EXPECT_LT(evaluation.ate->rmse_m, evaluation.odometry_ate->rmse_m);
  for (const auto& row : record.ledger) EXPECT_FALSE(core::reason_of(row.verdict).empty());

  // 16 x 10 m of office, 2.6 m high, seen by a camera that starts at the origin
  const auto num_inside =
      std::count_if(record.points.begin(), record.points.end(),
                    [](const auto& point) { return point.in_world.norm() < 20.0F; });
  EXPECT_GT(static_cast<double>(num_inside), 0.99 * static_cast<double>(record.points.size()));
}

}  // namespace
}  // namespace samewhere
