#include <gtest/gtest.h>

#include <samewhere/core/random.hpp>
#include <samewhere/geometry/uncertain_pose.hpp>

namespace samewhere::geometry {
namespace {

using core::Vector6d;

Vector6d random_vector(core::Random& random, double size) {
  Vector6d v;
  for (int i = 0; i < 6; ++i) v(i) = size * random.gaussian();
  return v;
}

UncertainPose random_uncertain_pose(core::Random& random) {
  core::Matrix6d root;
  for (int i = 0; i < 6; ++i) root.col(i) = random_vector(random, 0.002);
  return {core::exp_r3so3(random_vector(random, 0.7)), root * root.transpose()};
}

// A draw of the pose: error added to the translation, rotation error on the right.
core::Rigid3 drawn(const UncertainPose& pose, core::Random& random) {
  const core::Matrix6d root = pose.covariance.llt().matrixL();
  const Vector6d error = root * random_vector(random, 1.0);
  return {pose.a_from_b.rotation * core::exp_so3(error.tail<3>()),
          pose.a_from_b.translation + error.head<3>()};
}

Vector6d apart_of(const core::Rigid3& seen, const core::Rigid3& mean) {
  Vector6d error;
  error << seen.translation - mean.translation,
      core::log_so3(mean.rotation.conjugate() * seen.rotation);
  return error;
}

template <class Draw>
core::Matrix6d sampled_covariance(const core::Rigid3& mean, const Draw& draw) {
  constexpr int kDraws = 20000;
  core::Matrix6d sum = core::Matrix6d::Zero();
  for (int i = 0; i < kDraws; ++i) {
    const Vector6d error = apart_of(draw(), mean);
    sum += error * error.transpose();
  }
  return sum / kDraws;
}

TEST(UncertainPose, CompositionMatchesRandomDraws) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    core::Random random(seed);
    const UncertainPose a = random_uncertain_pose(random);
    const UncertainPose b = random_uncertain_pose(random);
    const UncertainPose both = compose(a, b);
    const auto sampled =
        sampled_covariance(both.a_from_b, [&] { return drawn(a, random) * drawn(b, random); });
    EXPECT_LT((sampled - both.covariance).norm(), 0.05 * both.covariance.norm()) << "seed " << seed;
  }
}

TEST(UncertainPose, InversionMatchesRandomDraws) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    core::Random random(seed);
    const UncertainPose a = random_uncertain_pose(random);
    const UncertainPose back = inverse(a);
    const auto sampled =
        sampled_covariance(back.a_from_b, [&] { return core::inverse(drawn(a, random)); });
    EXPECT_LT((sampled - back.covariance).norm(), 0.05 * back.covariance.norm()) << "seed " << seed;
    EXPECT_LT((inverse(back).covariance - a.covariance).norm(), 1e-9 * a.covariance.norm())
        << "seed " << seed;
  }
}

}  // namespace
}  // namespace samewhere::geometry
