#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <samewhere/verify/measure_odometry.hpp>
#include <samewhere/verify/variance_factor.hpp>

namespace samewhere::verify {
namespace {

constexpr double kPriorLoops = 2.0;
constexpr double kDegreesOfFreedom = 6.0;
constexpr double kLeastShareOfSigma = 0.25;
constexpr double kLeastShareOfVariance = 0.5;  // that earlier loops have left
constexpr double kLeastSigmas = 2.0;           // of drift over the error of the loop itself

}  // namespace

double variance_factor(const scene::MapVersion& map, double sigma_m, const Config& config) {
  double squares = kPriorLoops * kDegreesOfFreedom;
  double num = kPriorLoops * kDegreesOfFreedom;
  for (const scene::LoopEdge& loop : map.loops) {
    if (!loop.drift_sample || loop.drift_sample->sigma_m < kLeastShareOfSigma * sigma_m) continue;
    squares += loop.drift_sample->chi_square;
    num += kDegreesOfFreedom;
  }
  return std::clamp(squares / num, config.min_variance_factor, 1.0);
}

std::optional<scene::DriftSample> drift_sample(const core::Vector6d& error,
                                               const core::Matrix6d& covariance,
                                               const std::optional<core::Matrix6d>& with_loops,
                                               const Config& config) {
  const double sigma_m = least_certain_sigma_m(covariance);
  if (sigma_m < kLeastSigmas * config.loop_sigma_m) return std::nullopt;
  if (with_loops) {
    const double left = least_certain_sigma_m(*with_loops) / sigma_m;
    if (left * left < kLeastShareOfVariance) return std::nullopt;
  }
  const core::Matrix6d all = covariance + loop_information(config).inverse();
  return scene::DriftSample{.chi_square = error.dot(all.llt().solve(error)), .sigma_m = sigma_m};
}

double least_certain_sigma_m(const core::Matrix6d& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> of_position(covariance.topLeftCorner<3, 3>(),
                                                                   Eigen::EigenvaluesOnly);
  return std::sqrt(of_position.eigenvalues().maxCoeff());
}

}  // namespace samewhere::verify
