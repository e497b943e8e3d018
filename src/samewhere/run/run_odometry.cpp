#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/input/odometry_file.hpp>
#include <samewhere/run/run_odometry.hpp>

namespace samewhere::run {
namespace {

pipeline::OdometryConfig settled(pipeline::OdometryConfig config, const input::OdometryRows& rows) {
  using enum pipeline::OdometrySensor;
  if (config.sensor == kFile && !pipeline::has_covariances(rows)) config.sensor = kWheel;
  return config;
}

}  // namespace

pipeline::Config with_odometry_sensor(pipeline::Config config) {
  if (config.odometry.is_used())
    config.odometry =
        settled(config.odometry, input::read_odometry(config.odometry.file, config.input.topics));
  return config;
}

RunOdometry::RunOdometry(const pipeline::Config& config, const core::SourceInfo& source)
    : settings_(config.odometry), source_(source) {
  if (source.is_live && !source.is_video) {
    throw core::InputError(settings_.file +
                           ": odometry from a file needs a recording; found a live camera as "
                           "source");
  }
  input::OdometryRows rows = input::read_odometry(settings_.file, config.input.topics);
  settings_ = settled(settings_, rows);
  path_ = std::make_shared<const pipeline::OdometryPath>(settings_, std::move(rows));
}

void RunOdometry::see(const core::Frame& frame) {
  if (!first_frame_s_) {
    first_frame_s_ = frame.stamp_s;
    constexpr double kMargin = 1.5;  // the rate is a median
    const bool is_length_known = source_.num_frames > 0 && source_.frame_rate_hz > 0.0;
    const double latest_s =
        frame.stamp_s + kMargin * source_.num_frames / source_.frame_rate_hz + kMargin;
    if (frame.stamp_s > path_->last_s() || (is_length_known && latest_s < path_->first_s()))
      throw core::InputError(no_overlap(frame.stamp_s));
  }
  last_frame_s_ = frame.stamp_s;
  ++num_frames_;
  if (!path_->world_from_body(frame.stamp_s)) ++num_without_;
}

std::string RunOdometry::no_overlap(double last_frame_s) const {
  const std::string frames =
      last_frame_s > *first_frame_s_
          ? fmt::format("frames lie between {:.3f} and {:.3f} s", *first_frame_s_, last_frame_s)
          : fmt::format("first frame lies at {:.3f} s", *first_frame_s_);
  return fmt::format(
      "{}: has rows from {:.3f} to {:.3f} s, the {}; expected "
      "stamps of the same clock (images without stamps: names that are stamps, or a TUM rgb.txt)",
      settings_.file, path_->first_s(), path_->last_s(), frames);
}

report::Figure RunOdometry::figure() const {
  if (num_without_ > 0 && num_without_ < num_frames_) {
    spdlog::warn(
        "{}: {} of {} frames have no odometry (before, after or between rows more than "
        "odometry.max_gap_s apart); in a new map images alone track them, or lose them",
        settings_.file, num_without_, num_frames_);
  }
  return report::figure("frames without odometry", "{}", num_without_);
}

std::optional<report::Figure> RunOdometry::figure(const pipeline::ImageAgreement& agreement) const {
  constexpr double kMany = 0.2;
  const auto& [num_compared, num_contradicted] = agreement;
  if (num_compared == 0) return std::nullopt;
  if (num_contradicted > kMany * num_compared) {
    spdlog::warn(
        "{}: images contradict the odometry at {} of {} frames; expected: stamps of the clock of "
        "the images, poses of the body that carries the camera, wheels that do not slip",
        settings_.file, num_contradicted, num_compared);
  }
  return report::figure("frames whose images contradict odometry", "{} of {}", num_contradicted,
                        num_compared);
}

std::optional<std::string> RunOdometry::error() const {
  if (num_frames_ == 0 || num_without_ < num_frames_) return std::nullopt;
  return no_overlap(last_frame_s_);
}

}  // namespace samewhere::run
