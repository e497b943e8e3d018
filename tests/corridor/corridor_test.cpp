// Acceptance on the built-in world: a corridor whose doors look alike, walked once round and a bit
// further.

#include <gtest/gtest.h>
#include <opencv2/core/utility.hpp>

#include <samewhere/pipeline/figures.hpp>
#include <samewhere/pipeline/open_source.hpp>
#include <samewhere/pipeline/run.hpp>
#include <samewhere/report/html.hpp>
#include <samewhere/report/loops.hpp>

namespace samewhere {
namespace {

// One walk is enough for all questions about it.
class Corridor : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    cv::setNumThreads(1);
    pipeline::Config config;
    config.source = "twin:office-loop?seed=1";
    auto source = pipeline::open_source(config);
    truth_ = source->truth();
    outcome_ =
        std::make_unique<pipeline::RunOutcome>(pipeline::run_slam(std::move(source), config));
    evaluation_ = pipeline::evaluate_slam(pipeline::findings_of(outcome_->record), truth_);
  }
  static void TearDownTestSuite() { outcome_.reset(); }

  inline static std::unique_ptr<pipeline::RunOutcome> outcome_;
  inline static core::Truth truth_;
  inline static pipeline::SlamEvaluation evaluation_;
};

TEST_F(Corridor, EveryFrameIsMeasured) {
  EXPECT_EQ(evaluation_.num_measured, evaluation_.num_frames);
}

TEST_F(Corridor, TheTrueReturnIsFoundAndTheDriftGoes) {
  EXPECT_GE(evaluation_.loops.num_right, 1);
  ASSERT_TRUE(evaluation_.ate && evaluation_.odometry_ate);
  EXPECT_LT(evaluation_.ate->rmse_m, evaluation_.odometry_ate->rmse_m);
}

TEST_F(Corridor, ALookalikeDoorIsNeverMistakenForAnother) {
  EXPECT_EQ(evaluation_.loops.num_wrong, 0);
  EXPECT_GT(evaluation_.num_candidates, 100) << "zero wrong among none proves nothing";
}

TEST_F(Corridor, EveryRefusalHasAReason) {
  for (const auto& row : outcome_->record.ledger)
    EXPECT_FALSE(core::reason_of(row.verdict).empty());
}

TEST_F(Corridor, TheMapLiesWhereTheBuildingIs) {
  // 16 x 10 m of office, 2.6 m high, seen from a camera that starts at the origin
  int num_inside = 0;
  for (const auto& point : outcome_->record.points) {
    if (point.in_world.norm() < 20.0F) ++num_inside;
  }
  EXPECT_GT(num_inside, 0.99 * static_cast<double>(outcome_->record.points.size()));
}

}  // namespace
}  // namespace samewhere
