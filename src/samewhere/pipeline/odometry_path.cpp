#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Eigenvalues>

#include <samewhere/core/errors.hpp>
#include <samewhere/pipeline/odometry_path.hpp>

namespace samewhere::pipeline {
namespace {

using input::OdometryRow;
using input::OdometryRows;

// The axis of the world about which the body turns most. A body that moves upright turns about the
// vertical. Nothing if it turns little, or about several.
std::optional<Eigen::Vector3d> axis_of_turns(const Eigen::Matrix3d& turns) {
  constexpr double kMinTurned_rad = 1.0;
  constexpr double kMinRatio = 3.0;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(turns);
  const Eigen::Vector3d& turned_rad = solver.eigenvalues();  // ascending
  if (turned_rad(2) < kMinTurned_rad || turned_rad(2) < kMinRatio * turned_rad(1))
    return std::nullopt;
  return solver.eigenvectors().col(2);
}

// Nothing if the positions leave every plane, or lie on a line and turn about no axis.
std::optional<Eigen::Vector3d> normal_of(const Eigen::Matrix3d& positions,
                                         const std::optional<Eigen::Vector3d>& up) {
  constexpr double kMaxThickness_m = 1e-3;  // RMS, as the width
  constexpr double kMinWidth_m = 0.05;
  if (up && up->dot(positions * *up) <= kMaxThickness_m * kMaxThickness_m) return up;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(positions);
  const Eigen::Vector3d& variances = solver.eigenvalues();  // ascending
  if (variances(0) > kMaxThickness_m * kMaxThickness_m || variances(1) < kMinWidth_m * kMinWidth_m)
    return std::nullopt;
  return solver.eigenvectors().col(0);
}

// The first row after the moment.
OdometryRows::const_iterator first_after(const OdometryRows& rows, double stamp_s) {
  return std::upper_bound(rows.begin(), rows.end(), stamp_s,
                          [](double stamp, const OdometryRow& row) { return stamp < row.stamp_s; });
}

}  // namespace

bool has_covariances(const input::OdometryRows& rows) {
  return rows.size() > 1 && rows.back().covariance.has_value();
}

OdometryPath::OdometryPath(const OdometryConfig& config, OdometryRows rows)
    : config_(config), rows_(std::move(rows)), rates_(drift_rates(config)) {
  core::require(!rows_.empty(), "odometry has a row");
  uses_covariances_ = config.sensor == OdometrySensor::kFile;
  core::require(!uses_covariances_ || rows_.size() == 1 || has_covariances(rows_),
                "the file has covariances");
  for (std::size_t i = 1; i < rows_.size(); ++i) add_turn(rows_[i - 1], rows_[i]);
  for (const OdometryRow& row : rows_) add_position(row);
  find_axes();
}

void OdometryPath::add(const OdometryRow& row) {
  core::require(row.stamp_s > rows_.back().stamp_s, "rows of odometry ascend");
  core::require(!uses_covariances_ || row.covariance.has_value(), "the row has a covariance");
  add_turn(rows_.back(), row);
  add_position(row);
  find_axes();
  rows_.push_back(row);
}

void OdometryPath::add_position(const OdometryRow& row) {
  positions_.add(row.world_from_body.translation - rows_.front().world_from_body.translation);
}

void OdometryPath::find_axes() {
  up_in_world_ = axis_of_turns(turns_);
  normal_in_world_ = normal_of(positions_.covariance(), up_in_world_);
}

void OdometryPath::Positions::add(const Eigen::Vector3d& position) {
  ++count;
  sum += position;
  squares += position * position.transpose();
}

Eigen::Matrix3d OdometryPath::Positions::covariance() const {
  return squares / count - sum * sum.transpose() / (count * count);
}

void OdometryPath::add_turn(const OdometryRow& before, const OdometryRow& row) {
  const Eigen::Vector3d turn =
      before.world_from_body.rotation *
      core::log_so3(before.world_from_body.rotation.conjugate() * row.world_from_body.rotation);
  if (turn.norm() > 0.0) turns_ += turn * turn.transpose() / turn.norm();
}

core::Rigid3 OdometryPath::interpolated(double stamp_s) const {
  const auto after = first_after(rows_, stamp_s);
  if (after == rows_.begin()) return rows_.front().world_from_body;
  const OdometryRow& before = *std::prev(after);
  if (after == rows_.end()) return before.world_from_body;
  return interpolate(before.world_from_body, after->world_from_body,
                     (stamp_s - before.stamp_s) / (after->stamp_s - before.stamp_s));
}

std::optional<core::Rigid3> OdometryPath::world_from_body(double stamp_s) const {
  const auto after = first_after(rows_, stamp_s);
  if (after == rows_.begin()) return std::nullopt;
  const OdometryRow& before = *std::prev(after);
  if (before.stamp_s == stamp_s) return before.world_from_body;
  if (after == rows_.end() || after->stamp_s - before.stamp_s > config_.max_gap_s)
    return std::nullopt;
  return interpolated(stamp_s);
}

geometry::UncertainPose OdometryPath::motion(double from_s, double to_s) const {
  const OdometryStep between = step(from_s, to_s);
  if (!uses_covariances_)
    return {between.before_from_after, step_covariance(between, rates_, config_)};
  return {between.before_from_after,
          covariance_by_rows(from_s, to_s) + gap_covariance(between.gap_s, config_)};
}

std::optional<Eigen::Vector3d> OdometryPath::normal_in_body(double stamp_s) const {
  if (!normal_in_world_) return std::nullopt;
  return interpolated(stamp_s).rotation.conjugate() * *normal_in_world_;
}

// Of a gap longer than max_gap_s the motion at its ends is known, what lies between is not.
OdometryStep OdometryPath::step(double from_s, double to_s) const {
  OdometryStep step;
  const core::Rigid3 world_from_first = interpolated(from_s);
  core::Rigid3 world_from_last = world_from_first;
  double last_s = from_s;
  const auto go_to = [&](double stamp_s, const core::Rigid3& world_from_next) {
    const core::Rigid3 last_from_next = inverse(world_from_last) * world_from_next;
    step.length_m += last_from_next.translation.norm();
    step.turned_rad += core::angle_rad(last_from_next.rotation);
    world_from_last = world_from_next;
    last_s = stamp_s;
  };
  for (auto row = first_after(rows_, from_s); row != rows_.end() && row->stamp_s < to_s; ++row) {
    if (row->stamp_s - last_s > config_.max_gap_s) step.gap_s += row->stamp_s - last_s;
    go_to(row->stamp_s, row->world_from_body);
  }
  if (to_s - last_s > config_.max_gap_s) step.gap_s += to_s - last_s;
  go_to(to_s, interpolated(to_s));
  step.before_from_after = inverse(world_from_first) * world_from_last;
  step.duration_s = to_s - from_s;
  if (up_in_world_) step.up_in_before = world_from_first.rotation.conjugate() * *up_in_world_;
  return step;
}

// The increments of the rows in between, composed; of the first and the last by their share of
// time.
core::Matrix6d OdometryPath::covariance_by_rows(double from_s, double to_s) const {
  geometry::UncertainPose motion;
  double last_s = from_s;
  core::Rigid3 world_from_last = interpolated(from_s);
  for (auto row = first_after(rows_, from_s); row != rows_.end() && last_s < to_s; ++row) {
    if (row == rows_.begin()) continue;
    const double next_s = std::min(row->stamp_s, to_s);
    const core::Rigid3 world_from_next = interpolated(next_s);
    const double share = (next_s - last_s) / (row->stamp_s - std::prev(row)->stamp_s);
    motion = compose(motion, geometry::UncertainPose{inverse(world_from_last) * world_from_next,
                                                     share * *row->covariance});
    world_from_last = world_from_next;
    last_s = next_s;
  }
  return motion.covariance;
}

}  // namespace samewhere::pipeline
