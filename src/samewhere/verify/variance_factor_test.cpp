#include <gtest/gtest.h>

#include <samewhere/verify/test_corridor.hpp>
#include <samewhere/verify/variance_factor.hpp>

namespace samewhere::verify {
namespace {

scene::MapVersion with_samples(const std::vector<scene::DriftSample>& samples) {
  scene::Edit edit;
  for (const scene::DriftSample& sample : samples) {
    edit.loops.push_back(loop_beside(10, 1, 0.0));
    edit.loops.back().drift_sample = sample;
  }
  return apply(corridor(40), edit);
}

TEST(VarianceFactor, IsOneUntilLoopsHaveShownOtherwise) {
  EXPECT_EQ(variance_factor(with_samples({}), 1.0, {}), 1.0);
  EXPECT_NEAR(variance_factor(with_samples({{0.6, 1.0}}), 1.0, {}), 12.6 / 18.0, 1e-12);
  EXPECT_NEAR(variance_factor(with_samples({{0.6, 1.0}, {1.2, 1.0}}), 1.0, {}), 13.8 / 24.0, 1e-12);
}

TEST(VarianceFactor, HasALeastValueAndIsNeverAboveOne) {
  const std::vector<scene::DriftSample> exact(100, {0.0, 1.0});
  const std::vector<scene::DriftSample> poor(100, {16.0, 1.0});
  EXPECT_EQ(variance_factor(with_samples(exact), 1.0, {}), Config{}.min_variance_factor);
  EXPECT_EQ(variance_factor(with_samples(exact), 1.0, {.min_variance_factor = 1.0}), 1.0);
  EXPECT_EQ(variance_factor(with_samples(poor), 1.0, {}), 1.0);
}

TEST(VarianceFactor, ALittleDriftDoesNotTellOfALargeOne) {
  const scene::MapVersion map = with_samples({{0.0, 0.2}, {0.0, 0.2}});
  EXPECT_LT(variance_factor(map, 0.7, {}), 1.0);
  EXPECT_EQ(variance_factor(map, 0.9, {}), 1.0);
}

TEST(MeasureDrift, IsTheErrorOfOdometryUnderItsCovariance) {
  const scene::MapVersion map = corridor(40);
  const auto exact = TestDrift(map).sample(loop_beside(31, 1, 0.0));
  const auto off = TestDrift(map).sample(loop_beside(31, 1, 1.0));
  ASSERT_TRUE(exact && off);
  EXPECT_NEAR(exact->chi_square, 0.0, 1e-9);
  EXPECT_GT(off->chi_square, 0.1);
  EXPECT_EQ(off->sigma_m, exact->sigma_m);
  EXPECT_FALSE(TestDrift(map).sample(loop_beside(2, 1, 0.0))) << "as sure as the loop itself";
}

TEST(MeasureDrift, OfOneRevisitCountsTheFirstLoopAlone) {
  scene::MapVersion map = corridor(40);
  scene::Edit edit;
  edit.loops.push_back(loop_beside(31, 1, 0.0));
  map = apply(map, edit);
  EXPECT_FALSE(TestDrift(map).sample(loop_beside(32, 2, 0.0)));
  EXPECT_TRUE(TestDrift(map).sample(loop_beside(31, 16, 0.0))) << "half of it on its own";
}

TEST(VarianceFactor, MakesTheGateNarrowerAndTellsMoreFromALookAlike) {
  const scene::MapVersion map = corridor(40);
  const scene::LoopEdge claim = loop_beside(35, 5, 1.0);
  const auto before = TestDrift(map).odometry(claim);
  scene::Edit edit;
  edit.loops.push_back(loop_beside(31, 1, 0.0));
  edit.loops.back().drift_sample = TestDrift(map).sample(edit.loops.back());
  const scene::MapVersion with_loop = apply(map, edit);
  const auto after = TestDrift(with_loop).odometry(claim);
  EXPECT_NEAR(after.mahalanobis_squared, before.mahalanobis_squared * 18.0 / 12.0,
              0.01 * before.mahalanobis_squared);
  EXPECT_GT(*after.look_alike_gain, 1.4 * *before.look_alike_gain);
  EXPECT_LT(*after.sigma_m, *before.sigma_m);
  EXPECT_FALSE(before.variance_factor);
  EXPECT_NEAR(after.variance_factor.value_or(1.0), 12.0 / 18.0, 0.01);
  const auto unlearned = TestDrift(with_loop, {.min_variance_factor = 1.0}).odometry(claim);
  EXPECT_EQ(unlearned.mahalanobis_squared, before.mahalanobis_squared);
}

}  // namespace
}  // namespace samewhere::verify
