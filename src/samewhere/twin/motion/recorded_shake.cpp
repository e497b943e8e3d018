#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>
#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/twin/motion/path.hpp>
#include <samewhere/twin/motion/recorded_shake.hpp>
#include <samewhere/twin/motion/spline.hpp>

namespace samewhere::twin {
namespace {

constexpr double kStep_s = 0.05;
constexpr double kLeast_s = 10.0;
constexpr double kMostGap_s = 0.5;
constexpr double kSmooth_s = 0.5;  // standard deviation of the mean over time: steps do not pass
constexpr double kWalking_m_s = 0.2;

void check(const core::Trajectory& trajectory) {
  const double duration_s =
      trajectory.empty() ? 0.0 : trajectory.back().stamp_s - trajectory.front().stamp_s;
  if (duration_s < kLeast_s) {
    throw core::InputError(fmt::format("found {} poses over {:.1f} s, expected {:.0f} s at least",
                                       trajectory.size(), duration_s, kLeast_s));
  }
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    const double gap_s = trajectory[i].stamp_s - trajectory[i - 1].stamp_s;
    if (gap_s <= kMostGap_s) continue;
    throw core::InputError(
        fmt::format("found no pose for {:.2f} s after stamp {:.6f}, expected one "
                    "every {} s at least",
                    gap_s, trajectory[i - 1].stamp_s, kMostGap_s));
  }
}

// At equal steps.
std::vector<core::Rigid3> sampled(const core::Trajectory& trajectory) {
  std::vector<core::Rigid3> poses;
  const double first_s = trajectory.front().stamp_s;
  std::size_t next = 1;
  for (int k = 0; first_s + k * kStep_s <= trajectory.back().stamp_s; ++k) {
    const double stamp_s = first_s + k * kStep_s;
    while (next + 1 < trajectory.size() && trajectory[next].stamp_s < stamp_s) ++next;
    const core::StampedPose& a = trajectory[next - 1];
    const core::StampedPose& b = trajectory[next];
    const double share = (stamp_s - a.stamp_s) / (b.stamp_s - a.stamp_s);
    const auto& from = a.world_from_camera;
    const auto& to = b.world_from_camera;
    poses.push_back({from.rotation.slerp(share, to.rotation),
                     (1.0 - share) * from.translation + share * to.translation});
  }
  return poses;
}

// The mean around each, with the weights of a normal distribution.
template <class T>
std::vector<T> smoothed(const std::vector<T>& values) {
  const int reach = static_cast<int>(std::lround(3.0 * kSmooth_s / kStep_s));
  const auto last = static_cast<int>(values.size()) - 1;
  std::vector<T> means;
  for (int i = 0; i <= last; ++i) {
    // as far on either side, so that a straight way stays where it is
    const int near = std::min({reach, i, last - i});
    T sum = values[static_cast<std::size_t>(i)];
    double weights = 1.0;
    for (int k = 1; k <= near; ++k) {
      const double weight = std::exp(-0.5 * std::pow(k * kStep_s / kSmooth_s, 2));
      sum += weight * values[static_cast<std::size_t>(i - k)];
      sum += weight * values[static_cast<std::size_t>(i + k)];
      weights += 2.0 * weight;
    }
    means.push_back(sum / weights);
  }
  return means;
}

struct SmoothWay {
  std::vector<Eigen::Vector3d> positions_m;
  std::vector<double> headings_rad;
  std::vector<bool> is_walking;
};

SmoothWay smooth_way(const std::vector<core::Rigid3>& poses) {
  std::vector<Eigen::Vector3d> positions_m;
  for (const core::Rigid3& pose : poses) positions_m.push_back(pose.translation);
  SmoothWay way{.positions_m = smoothed(positions_m), .headings_rad = {}, .is_walking = {}};
  const std::size_t last = poses.size() - 1;
  double heading_rad = 0.0;
  for (std::size_t i = 0; i <= last; ++i) {
    const Eigen::Vector3d& before = way.positions_m[i == 0 ? 0 : i - 1];
    const Eigen::Vector3d& after = way.positions_m[std::min(i + 1, last)];
    const double steps = i == 0 || i == last ? 1.0 : 2.0;
    way.is_walking.push_back((after - before).head<2>().norm() > kWalking_m_s * steps * kStep_s);
    if (way.is_walking.back())
      heading_rad = unwrapped(heading_between(before, after, heading_rad), heading_rad);
    way.headings_rad.push_back(heading_rad);
  }
  const auto num_walking = std::count(way.is_walking.begin(), way.is_walking.end(), true);
  if (2 * num_walking < std::ssize(way.is_walking)) {
    throw core::InputError(
        fmt::format("found {:.0f} % of the time at {} m/s or faster, expected a walk: 50 %",
                    100.0 * static_cast<double>(num_walking) / static_cast<double>(poses.size()),
                    kWalking_m_s));
  }
  // until the first step: the heading of that step
  const auto first = std::find(way.is_walking.begin(), way.is_walking.end(), true);
  std::fill(way.headings_rad.begin(), way.headings_rad.begin() + (first - way.is_walking.begin()),
            way.headings_rad[static_cast<std::size_t>(first - way.is_walking.begin())]);
  way.headings_rad = smoothed(way.headings_rad);
  return way;
}

Eigen::Quaterniond about_up(double angle_rad) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle_rad, Eigen::Vector3d::UnitZ()));
}

// Of the attitudes on the way: the eigenvector of the mean of q q^T (Markley et al., JGCD 2007).
Eigen::Quaterniond mean_of(const std::vector<Eigen::Quaterniond>& rotations) {
  Eigen::Matrix4d sum = Eigen::Matrix4d::Zero();
  for (const auto& rotation : rotations) sum += rotation.coeffs() * rotation.coeffs().transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> solver(sum);
  return Eigen::Quaterniond(Eigen::Vector4d(solver.eigenvectors().col(3)));
}

// Yaw, pitch and roll of a rotation in axes forward, left, up.
Eigen::Vector3d angles_of(const Eigen::Matrix3d& turned) {
  return {std::atan2(turned(1, 0), turned(0, 0)), std::asin(std::clamp(turned(2, 0), -1.0, 1.0)),
          std::atan2(turned(2, 1), turned(2, 2))};
}

}  // namespace

RecordedShake::RecordedShake(const core::Trajectory& trajectory) {
  check(trajectory);
  const std::vector<core::Rigid3> poses = sampled(trajectory);
  const SmoothWay way = smooth_way(poses);
  std::vector<Eigen::Quaterniond> attitudes;  // in axes of the way
  for (std::size_t i = 0; i < poses.size(); ++i)
    attitudes.push_back(about_up(-way.headings_rad[i]) * poses[i].rotation);
  std::vector<Eigen::Quaterniond> walking;
  for (std::size_t i = 0; i < poses.size(); ++i)
    if (way.is_walking[i]) walking.push_back(attitudes[i]);
  const Eigen::Quaterniond mean = mean_of(walking);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    Values values;
    values.head<3>() = about_up(-way.headings_rad[i]) * (poses[i].translation - way.positions_m[i]);
    values.tail<3>() = angles_of((attitudes[i] * mean.conjugate()).toRotationMatrix());
    values.head<3>() = values.head<3>().cwiseMax(-kMostShake_m).cwiseMin(kMostShake_m);
    values.tail<3>() = values.tail<3>().cwiseMax(-kMostShake_rad).cwiseMin(kMostShake_rad);
    values_.push_back(values);
  }
}

double RecordedShake::duration_s() const {
  return is_empty() ? 0.0 : kStep_s * static_cast<double>(values_.size() - 1);
}

std::array<Jet, kShakeChannels> RecordedShake::at(double stamp_s) const {
  std::array<Jet, kShakeChannels> jets{};
  if (is_empty()) return jets;
  const double knot = stamp_s / kStep_s;
  const double begin = std::floor(knot);
  const auto weights = spline_weights(knot - begin);
  const auto last = static_cast<double>(values_.size() - 1);
  Eigen::Matrix<double, kShakeChannels, 3> sums = Eigen::Matrix<double, kShakeChannels, 3>::Zero();
  for (int i = 0; i < 4; ++i) {
    const double place = std::abs(std::remainder(begin - 1.0 + i, 2.0 * last));
    sums += values_[static_cast<std::size_t>(place)] * weights.col(i).transpose();
  }
  for (int channel = 0; channel < kShakeChannels; ++channel)
    jets[static_cast<std::size_t>(channel)] = {sums(channel, 0), sums(channel, 1) / kStep_s,
                                               sums(channel, 2) / (kStep_s * kStep_s)};
  return jets;
}

}  // namespace samewhere::twin
