#include <gtest/gtest.h>

#include <samewhere/verify/measure_odometry.hpp>
#include <samewhere/verify/variance_factor.hpp>

namespace samewhere::verify {
namespace {

// Keyframes one metre apart in a line, 5 cm and 0.05 rad of drift each.
scene::MapVersion line_of_keyframes(int count) {
  scene::Edit edit;
  const core::Rigid3 step{Eigen::Quaterniond::Identity(), {0, 0, 1}};
  core::Rigid3 pose;
  for (int i = 0; i < count; ++i) {
    scene::Keyframe keyframe;
    keyframe.id = core::KeyframeId(static_cast<std::uint64_t>(i));
    keyframe.world_from_body = pose;
    if (i > 0)
      keyframe.odometry = {core::KeyframeId(static_cast<std::uint64_t>(i - 1)), step,
                           400.0 * core::Matrix6d::Identity()};
    edit.keyframes.push_back(keyframe);
    pose = pose * step;
  }
  return apply(scene::MapVersion{}, edit);
}

scene::LoopEdge loop_between(int query, int match, double error_m) {
  scene::LoopEdge loop;
  loop.query = core::KeyframeId(static_cast<std::uint64_t>(query));
  loop.match = core::KeyframeId(static_cast<std::uint64_t>(match));
  loop.match_from_query.translation = {error_m, 0, 1.0 * (query - match)};
  loop.information = loop_information({});
  return loop;
}

scene::MapVersion with_samples(const std::vector<scene::DriftSample>& samples) {
  scene::Edit edit;
  for (const scene::DriftSample& sample : samples) {
    edit.loops.push_back(loop_between(10, 1, 0.0));
    edit.loops.back().drift_sample = sample;
  }
  return apply(line_of_keyframes(40), edit);
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
  const scene::MapVersion map = line_of_keyframes(40);
  const auto exact = measure_drift(map, loop_between(31, 1, 0.0), {}, {});
  const auto off = measure_drift(map, loop_between(31, 1, 1.0), {}, {});
  ASSERT_TRUE(exact && off);
  EXPECT_NEAR(exact->chi_square, 0.0, 1e-9);
  EXPECT_GT(off->chi_square, 0.1);
  EXPECT_EQ(off->sigma_m, exact->sigma_m);
  EXPECT_FALSE(measure_drift(map, loop_between(2, 1, 0.0), {}, {})) << "as sure as the loop itself";
}

TEST(MeasureDrift, OfOneRevisitCountsTheFirstLoopAlone) {
  scene::MapVersion map = line_of_keyframes(40);
  scene::Edit edit;
  edit.loops.push_back(loop_between(31, 1, 0.0));
  map = apply(map, edit);
  EXPECT_FALSE(measure_drift(map, loop_between(32, 2, 0.0), {}, {}));
  EXPECT_TRUE(measure_drift(map, loop_between(31, 16, 0.0), {}, {})) << "half of it on its own";
}

TEST(VarianceFactor, MakesTheGateNarrowerAndTellsMoreFromALookAlike) {
  const scene::MapVersion map = line_of_keyframes(40);
  const scene::LoopEdge claim = loop_between(35, 5, 1.0);
  const auto before = measure_odometry(map, claim, {}, {});
  scene::Edit edit;
  edit.loops.push_back(loop_between(31, 1, 0.0));
  edit.loops.back().drift_sample = measure_drift(map, edit.loops.back(), {}, {});
  const scene::MapVersion with_loop = apply(map, edit);
  const auto after = measure_odometry(with_loop, claim, {}, {});
  EXPECT_NEAR(after.mahalanobis_squared, before.mahalanobis_squared * 18.0 / 12.0,
              0.01 * before.mahalanobis_squared);
  EXPECT_GT(*after.look_alike_gain, 1.4 * *before.look_alike_gain);
  EXPECT_LT(*after.sigma_m, *before.sigma_m);
  const auto unlearned = measure_odometry(with_loop, claim, {}, {.min_variance_factor = 1.0});
  EXPECT_EQ(unlearned.mahalanobis_squared, before.mahalanobis_squared);
}

}  // namespace
}  // namespace samewhere::verify
