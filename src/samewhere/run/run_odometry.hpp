#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <samewhere/core/frame.hpp>
#include <samewhere/core/source.hpp>
#include <samewhere/pipeline/config.hpp>
#include <samewhere/pipeline/odometry_path.hpp>
#include <samewhere/pipeline/odometry_tracking.hpp>
#include <samewhere/report/figure.hpp>

namespace samewhere::run {

// The config with what odometry.sensor = file means for its file: without covariances, wheels.
// Throws InputError if the file cannot be read (input/odometry_file.hpp).
pipeline::Config with_odometry_sensor(pipeline::Config config);

// Odometry from a file in a run: which frames it covers.
class RunOdometry {
 public:
  // The config names a file. Throws InputError if it cannot be read, or if the source is a camera:
  // a file has no pose of what is yet to come.
  RunOdometry(const pipeline::Config& config, const core::SourceInfo& source);

  // With the sensor as with_odometry_sensor() has it.
  const pipeline::OdometryConfig& settings() const { return settings_; }
  const std::shared_ptr<const pipeline::OdometryPath>& path() const { return path_; }
  // Before the frame is worked on. Throws InputError at the first one if no later one can have
  // odometry: the stamps are those of another clock.
  void see(const core::Frame& frame);
  // When all frames were seen: how many have no odometry, with a warning if any. An error: none
  // has.
  report::Figure figure() const;
  // At how many frames images contradict odometry, with a warning if at many: clocks that differ, a
  // wrong extrinsic, slip. Nothing where none could be compared.
  std::optional<report::Figure> figure(const pipeline::ImageAgreement& agreement) const;
  std::optional<std::string> error() const;

 private:
  std::string no_overlap(double last_frame_s) const;

  pipeline::OdometryConfig settings_;
  core::SourceInfo source_;
  std::shared_ptr<const pipeline::OdometryPath> path_;
  std::optional<double> first_frame_s_;
  double last_frame_s_ = 0.0;
  int num_frames_ = 0;
  int num_without_ = 0;
};

}  // namespace samewhere::run
