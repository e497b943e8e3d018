#include <algorithm>
#include <cmath>
#include <numeric>

#include <Eigen/Cholesky>

#include <samewhere/core/median.hpp>
#include <samewhere/evaluate/consistency.hpp>
#include <samewhere/evaluate/trajectory_error.hpp>

namespace samewhere::evaluate {
namespace {

constexpr double kNumDegrees = 6.0;
constexpr double kChiSquare99 = 16.812;  // with 6 degrees of freedom
constexpr double kNormal95 = 1.96;

double nees_of(const MeasuredMotion& motion, const core::Rigid3& truth) {
  const core::Rigid3& measured = motion.from_from_to.a_from_b;
  core::Vector6d error;
  error << measured.translation - truth.translation,
      core::log_so3(truth.rotation.conjugate() * measured.rotation);
  return error.dot(motion.from_from_to.covariance.llt().solve(error));
}

}  // namespace

std::optional<Consistency> consistency(const std::vector<MeasuredMotion>& motions,
                                       const core::Trajectory& truth) {
  std::vector<double> squares;
  for (const auto& motion : motions) {
    const auto from = truth_at(truth, motion.from_s);
    const auto to = truth_at(truth, motion.to_s);
    if (from && to) squares.push_back(nees_of(motion, inverse(*from) * *to));
  }
  if (squares.size() < 2) return std::nullopt;
  const auto count = static_cast<double>(squares.size());
  const auto num_outliers =
      std::count_if(squares.begin(), squares.end(), [](double s) { return s > kChiSquare99; });
  const double half_band = kNormal95 * std::sqrt(2.0 * kNumDegrees / count);
  return Consistency{.num_motions = static_cast<int>(squares.size()),
                     .mean = std::accumulate(squares.begin(), squares.end(), 0.0) / count,
                     .median = *core::median(squares),
                     .band_low = kNumDegrees - half_band,
                     .band_high = kNumDegrees + half_band,
                     .outliers = static_cast<double>(num_outliers) / count};
}

}  // namespace samewhere::evaluate
