#pragma once

#include <optional>
#include <vector>

#include <samewhere/core/rigid3.hpp>
#include <samewhere/geometry/uncertain_pose.hpp>
#include <samewhere/input/odometry_file.hpp>
#include <samewhere/pipeline/odometry_drift.hpp>

namespace samewhere::pipeline {

// Whether the rows have the covariances that sensor `file` takes.
bool has_covariances(const input::OdometryRows& rows);

// The motion of the body by an odometry file, at any moment that its rows cover.
class OdometryPath {
 public:
  // Throws ContractError without a row, and for sensor `file` without covariances.
  OdometryPath(const OdometryConfig& config, input::OdometryRows rows);

  // The next row of odometry that comes with the frames, later than the last. For sensor `file` it
  // has a covariance. Then the constructor takes the first row alone.
  void add(const input::OdometryRow& row);

  double first_s() const { return rows_.front().stamp_s; }
  double last_s() const { return rows_.back().stamp_s; }

  // Pose at the moment, in the file's world: interpolated between rows at most
  // OdometryConfig::max_gap_s apart. Nothing in longer gaps, before the first and after the last.
  std::optional<core::Rigid3> world_from_body(double stamp_s) const;

  // Between two moments that have a pose, from <= to: the pose of the body at `to` in that at
  // `from` with its covariance, without what of the drift is constant over the run.
  geometry::UncertainPose motion(double from_s, double to_s) const;

  // Of the time between two moments, how much lies in gaps longer than OdometryConfig::max_gap_s.
  double gap_s(double from_s, double to_s) const { return step(from_s, to_s).gap_s; }

  // If the positions of all rows lie in a plane: its normal in the body at a moment that has a
  // pose. Such odometry measures no height.
  std::optional<Eigen::Vector3d> normal_in_body(double stamp_s) const;

 private:
  core::Rigid3 interpolated(double stamp_s) const;
  OdometryStep step(double from_s, double to_s) const;
  core::Matrix6d covariance_by_rows(double from_s, double to_s) const;
  // Of all rows, from the first.
  struct Positions {
    double count = 0.0;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();

    void add(const Eigen::Vector3d& position);
    Eigen::Matrix3d covariance() const;
  };

  void add_turn(const input::OdometryRow& before, const input::OdometryRow& row);
  void add_position(const input::OdometryRow& row);
  void find_axes();

  OdometryConfig config_;
  input::OdometryRows rows_;
  bool uses_covariances_ = false;
  DriftRates rates_;
  // Axis of the file's world that the body turns about; none: no single one.
  std::optional<Eigen::Vector3d> up_in_world_;
  Eigen::Matrix3d turns_ = Eigen::Matrix3d::Zero();  // about each axis, radians
  Positions positions_;
  std::optional<Eigen::Vector3d> normal_in_world_;  // of the plane that the positions lie in
};

}  // namespace samewhere::pipeline
