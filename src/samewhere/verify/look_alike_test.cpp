#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include <samewhere/verify/look_alike.hpp>

namespace samewhere::verify {
namespace {

core::Matrix6d covariance_of(const Eigen::Vector3d& sigma_m, double sigma_rad) {
  core::Vector6d diagonal;
  diagonal << sigma_m.cwiseAbs2(), Eigen::Vector3d::Constant(sigma_rad * sigma_rad);
  return diagonal.asDiagonal();
}

core::Vector6d error_of(const Eigen::Vector3d& metres, double heading_rad = 0.0) {
  core::Vector6d error = core::Vector6d::Zero();
  error.head<3>() = metres;
  error(4) = heading_rad;
  return error;
}

double chi_square(const core::Vector6d& error, const core::Matrix6d& covariance) {
  return error.dot(covariance.llt().solve(error));
}

// The same by trying directions.
double by_search(const core::Vector6d& error, const core::Matrix6d& covariance, double distance_m) {
  constexpr int kSteps = 400;
  double best = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= kSteps; ++i) {
    for (int j = 0; j < 2 * kSteps; ++j) {
      const double polar = M_PI * i / kSteps;
      const double around = M_PI * j / kSteps;
      core::Vector6d moved = error;
      moved.head<3>() -=
          distance_m * Eigen::Vector3d(std::sin(polar) * std::cos(around),
                                       std::sin(polar) * std::sin(around), std::cos(polar));
      best = std::min(best, chi_square(moved, covariance));
    }
  }
  return best - chi_square(error, covariance);
}

TEST(LookAlikeGain, IsThatOfTheDistanceInTheLeastCertainDirection) {
  const auto covariance = covariance_of({0.2, 0.5, 0.1}, 0.02);
  EXPECT_NEAR(look_alike_gain(error_of({0, 0, 0}), covariance, 3.0), 36.0, 1e-6);
}

TEST(LookAlikeGain, DecreasesAsTheErrorGrowsAndWithTheUncertainty) {
  const auto certain = covariance_of({0.5, 0.5, 0.5}, 0.02);
  const auto uncertain = covariance_of({2.0, 0.5, 0.5}, 0.02);
  const double without_error = look_alike_gain(error_of({0, 0, 0}), certain, 3.0);
  const double with_error = look_alike_gain(error_of({0.8, 0, 0}), certain, 3.0);
  EXPECT_GT(without_error, with_error);
  // one standard deviation is (3 - 0.8)^2 / 0.25 - 0.8^2 / 0.25
  EXPECT_NEAR(with_error, (2.2 * 2.2 - 0.8 * 0.8) / 0.25, 1e-6);
  EXPECT_LT(look_alike_gain(error_of({0, 0, 0}), uncertain, 3.0), 3.0);
}

TEST(LookAlikeGain, IsNegativeWhereALookAlikeExplainsTheErrorBetter) {
  const auto covariance = covariance_of({1.0, 1.0, 1.0}, 0.02);
  EXPECT_NEAR(look_alike_gain(error_of({3.5, 0, 0}), covariance, 3.0), -3.5 * 3.5, 1e-6);
  EXPECT_LT(look_alike_gain(error_of({2.0, 0, 0}), covariance, 3.0), 0.0);
}

TEST(LookAlikeGain, AgreesWithASearchOfDirections) {
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix();
  core::Matrix6d covariance = covariance_of({0.4, 1.1, 0.7}, 0.03);
  covariance.topLeftCorner<3, 3>() = turn * covariance.topLeftCorner<3, 3>() * turn.transpose();
  // a heading error has moved the camera sideways
  core::Matrix6d lever = core::Matrix6d::Identity();
  lever(0, 4) = 15.0;
  covariance = lever * covariance * lever.transpose();
  for (const core::Vector6d& error :
       {error_of({0.3, -0.6, 0.2}, 0.01), error_of({-1.0, 0.4, 0.9}, -0.05)}) {
    EXPECT_NEAR(look_alike_gain(error, covariance, 2.5), by_search(error, covariance, 2.5),
                0.02 * std::abs(by_search(error, covariance, 2.5)) + 0.01);
  }
}

// The heading that the loop measures says how far the camera has drifted sideways.
TEST(LookAlikeGain, UsesTheHeadingOfTheLoop) {
  core::Matrix6d covariance = covariance_of({0.3, 0.3, 0.3}, 0.05);
  core::Matrix6d lever = core::Matrix6d::Identity();
  lever(0, 4) = 30.0;
  covariance = lever * covariance * lever.transpose();
  EXPECT_LT(std::sqrt(covariance(0, 0)), 1.6);
  EXPECT_GT(look_alike_gain(error_of({1.5, 0, 0}, 0.05), covariance, 3.0), 12.0);
  EXPECT_LT(look_alike_gain(error_of({1.5, 0, 0}, -0.05), covariance, 3.0), 0.0);
}

}  // namespace
}  // namespace samewhere::verify
