#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include <samewhere/core/random.hpp>
#include <samewhere/optimize/manifold.hpp>
#include <samewhere/track/drift_model.hpp>

namespace samewhere::track {
namespace {

core::Rigid3 random_pose(core::Random& random) {
  const auto three = [&] {
    return Eigen::Vector3d(random.gaussian(), random.gaussian(), random.gaussian());
  };
  return {core::exp_so3(three()), three()};
}

// One standard deviation of the frame's pose in each direction.
constexpr std::array<double, 6> kSigma = {1e-4, 2e-4, 3e-4, 4e-4, 5e-4, 6e-4};

core::Matrix6d covariance() {
  core::Vector6d squares;
  for (int i = 0; i < 6; ++i) squares[i] = kSigma[i] * kSigma[i];
  return squares.asDiagonal();
}

// Of a camera that is calibrated without an error.
DriftConfig calibrated() {
  DriftConfig config;
  config.factor = 100.0;
  config.per_metre = config.per_radian = 0.0;
  return config;
}

// [translation in the reference; rotation on the right], as an edge of the map has it.
core::Vector6d error_of(const core::Rigid3& found, const core::Rigid3& truth) {
  core::Vector6d error;
  error << found.translation - truth.translation,
      core::log_so3(truth.rotation.conjugate() * found.rotation);
  return error;
}

TEST(DriftModel, AnErrorOfOneSigmaOfTheFrameIsOneSigmaOfTheEdge) {
  const DriftConfig config = calibrated();
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    core::Random random(seed);
    const core::Rigid3 camera_from_reference = random_pose(random);
    const core::Rigid3 body_from_camera = random_pose(random);
    const core::Matrix6d information =
        odometry_information(camera_from_reference, body_from_camera, covariance(), false, config);
    const auto edge = [&](const core::Rigid3& camera) {
      return inverse(body_from_camera * camera);
    };
    for (int i = 0; i < 6; ++i) {
      const core::Vector6d step = kSigma[i] * core::Vector6d::Unit(i);
      const core::Vector6d error = error_of(edge(optimize::retract(camera_from_reference, step)),
                                            edge(camera_from_reference));
      EXPECT_NEAR(config.factor * config.factor * error.dot(information * error), 1.0, 1e-2)
          << "seed " << seed << ", direction " << i;
    }
  }
}

TEST(DriftModel, IsAsSureWhicheverReferenceTheFrameIsGivenIn) {
  const DriftConfig config = calibrated();
  core::Random random(3);
  const core::Rigid3 camera_from_old = random_pose(random);
  const core::Rigid3 new_from_old = random_pose(random);
  const core::Rigid3 body_from_camera = random_pose(random);
  const core::Rigid3 old_from_new = inverse(new_from_old);
  // the same errors as steps of camera_from_new
  core::Matrix6d by_old = core::Matrix6d::Identity();
  for (int i = 0; i < 3; ++i) {
    by_old.block<3, 1>(0, 3 + i) =
        Eigen::Vector3d::Unit(i).cross(camera_from_old.rotation * old_from_new.translation);
  }
  const core::Matrix6d direct =
      odometry_information(camera_from_old * old_from_new, body_from_camera,
                           by_old * covariance() * by_old.transpose(), false, config);
  const core::Matrix6d passed_on = seen_from(
      new_from_old,
      odometry_information(camera_from_old, body_from_camera, covariance(), false, config));
  EXPECT_LT((direct - passed_on).norm(), 1e-4 * direct.norm());
}

TEST(DriftModel, IsLessSureTheFartherAndTheWeaker) {
  const DriftConfig config;
  const auto information = [&](const core::Rigid3& reference_from_body, bool is_weak) {
    return odometry_information(inverse(reference_from_body), {}, 1e-10 * covariance(), is_weak,
                                config);
  };
  const core::Rigid3 near{Eigen::Quaterniond::Identity(), {0.1, 0.0, 0.0}};
  const core::Rigid3 far{core::exp_so3({0.0, 1.0, 0.0}), {2.0, 0.0, 0.0}};
  EXPECT_NEAR(information(far, false)(0, 0) * std::pow(2.0 * config.per_metre, 2), 1.0, 0.02);
  EXPECT_NEAR(information(far, false)(4, 4) * std::pow(config.per_radian, 2), 1.0, 0.02);
  for (int i = 0; i < 6; ++i) {
    EXPECT_GT(information(near, false)(i, i), information(far, false)(i, i));
    EXPECT_NEAR(information(far, true)(i, i) * std::pow(config.weak_factor, 2),
                information(far, false)(i, i), 1e-6 * information(far, false)(i, i));
  }
}

}  // namespace
}  // namespace samewhere::track
