#include <algorithm>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <fmt/format.h>
#include <opencv2/core/utility.hpp>

#include <samewhere/library/border.hpp>
#include <samewhere/library/convert.hpp>
#include <samewhere/library/frame_intake.hpp>
#include <samewhere/library/map_content.hpp>
#include <samewhere/loop_closer.hpp>
#include <samewhere/pipeline/odometry_path.hpp>
#include <samewhere/pipeline/slam.hpp>
#include <samewhere/run/open_source.hpp>

namespace samewhere {
namespace {

pipeline::OdometrySensor sensor_of(OdometrySensor sensor) {
  switch (sensor) {
    case OdometrySensor::kCovariances:
      return pipeline::OdometrySensor::kFile;
    case OdometrySensor::kWheel:
      return pipeline::OdometrySensor::kWheel;
    case OdometrySensor::kLeg:
      return pipeline::OdometrySensor::kLeg;
    case OdometrySensor::kInertial:
      return pipeline::OdometrySensor::kInertial;
    case OdometrySensor::kVisual:
      return pipeline::OdometrySensor::kVisual;
    case OdometrySensor::kPoor:
      break;
  }
  return pipeline::OdometrySensor::kPoor;
}

// What is given are keyframes: each is used, and between two of them odometry has no gap. The
// settings that are given come later and win.
std::vector<std::string> settings_of(const LoopCloserOptions& options) {
  std::vector<std::string> settings;
  if (options.are_keyframes) {
    settings = {"map.visible_after_frames=1", "odometry.max_gap_s=3600",
                "odometry.keyframe_distance_m=0.01"};
  }
  settings.insert(settings.end(), options.settings.begin(), options.settings.end());
  return settings;
}

pipeline::Config config_of(const LoopCloserOptions& options) {
  pipeline::Config config =
      library::config_of(options.profile, settings_of(options), options.prior);
  config.threads = options.threads;
  config.odometry.file = "LoopCloser";
  config.odometry.sensor = sensor_of(options.sensor);
  return config;
}

bool is_covariance(const Covariance& covariance) {
  constexpr double kTolerance = 1e-6;
  return covariance.allFinite() &&
         (covariance - covariance.transpose()).norm() <= kTolerance * covariance.norm() &&
         covariance.llt().info() == Eigen::Success;
}

}  // namespace

class LoopCloser::Session {
 public:
  Session(const Calibration& calibration, const LoopCloserOptions& options)
      : config_(config_of(options)), intake_(calibration, config_) {
    cv::setNumThreads(1);
    config_ = run::with_window_in_frames(config_, intake_.info());
    slam_.emplace(config_, intake_.is_without_scale() ? pipeline::DepthFrom::kMotion
                                                      : pipeline::DepthFrom::kSensor);
    map_.set(library::snapshot({}, true));
  }

  std::vector<LoopVerdict> add(const OdometryFrame& keyframe) {
    const library::Door::Call call(door_, "add()");
    door_.require_open("add()");
    if (is_finished_) throw UsageError("add(): the session is finished");
    library::at_border([&] { check(keyframe); });
    return door_.decisive([&] {
      add_row(keyframe);
      slam_->feed(intake_.take(keyframe.frame));
      publish(slam_->visible_map());
      return verdicts();
    });
  }

  std::vector<LoopVerdict> finish() {
    const library::Door::Call call(door_, "finish()");
    door_.require_open("finish()");
    if (is_finished_) return {};
    return door_.decisive([&] {
      slam_->finish();
      is_finished_ = true;
      publish(slam_->map());
      return verdicts();
    });
  }

  std::vector<CorrectedPose> poses() {
    const library::Door::Call call(door_, "poses()");
    door_.require_open("poses()");
    const scene::MapVersion& map = current();
    const core::Rigid3 odom_from_map = first_in_odom(map);
    std::vector<CorrectedPose> poses;
    for (const core::FramePose& frame : slam_->frames()) {
      if (!is_confirmed(frame) || frame.reference_keyframe.index() >= map.keyframes.size())
        continue;
      poses.push_back(
          {frame.stamp_s, library::pose_of(odom_from_map * world_from_frame(map, frame))});
    }
    return poses;
  }

  std::shared_ptr<const Map> map() const { return map_.get(); }

 private:
  void check(const OdometryFrame& keyframe) const {
    intake_.check(keyframe.frame);
    const std::string name = fmt::format("keyframe {}", slam_->frames().size());
    if (!library::is_rigid(keyframe.odom_from_body)) {
      throw core::InputError(name +
                             ": odom_from_body is not finite or no rotation; expected a "
                             "rigid pose");
    }
    if (keyframe.covariance && !is_covariance(*keyframe.covariance)) {
      throw core::InputError(name +
                             ": the covariance is not finite, symmetric and positive "
                             "definite; expected one of [m; rad]");
    }
    const bool needs_covariance =
        path_ != nullptr && config_.odometry.sensor == pipeline::OdometrySensor::kFile;
    if (needs_covariance && !keyframe.covariance) {
      throw core::InputError(name +
                             ": has no covariance; expected one of the motion since the "
                             "keyframe before (OdometrySensor::kCovariances)");
    }
  }

  void add_row(const OdometryFrame& keyframe) {
    const input::OdometryRow row{keyframe.frame.stamp_s, library::rigid_of(keyframe.odom_from_body),
                                 keyframe.covariance};
    if (path_ != nullptr) {
      path_->add(row);
      return;
    }
    path_ = std::make_shared<pipeline::OdometryPath>(config_.odometry, input::OdometryRows{row});
    slam_->follow(path_);
  }

  const scene::MapVersion& current() const {
    return is_finished_ ? slam_->map() : slam_->visible_map();
  }

  // The map begins with a keyframe at its origin.
  core::Rigid3 first_in_odom(const scene::MapVersion& map) const {
    if (map.keyframes.empty()) return {};
    const auto odom = path_->world_from_body(map.keyframes[0].view.stamp_s);
    return odom ? *odom * inverse(map.keyframes[0].world_from_body) : core::Rigid3{};
  }

  std::vector<LoopVerdict> verdicts() const {
    std::vector<LoopVerdict> verdicts;
    for (const core::LedgerRow& row : slam_->newest_rows())
      verdicts.push_back(library::verdict_of(row));
    return verdicts;
  }

  void publish(const scene::MapVersion& map) {
    if (map_.get()->version() != map.number) map_.set(library::snapshot(map, true));
  }

  library::Door door_;
  pipeline::Config config_;
  library::FrameIntake intake_;
  std::shared_ptr<pipeline::OdometryPath> path_;
  core::Guarded<std::shared_ptr<const Map>> map_;
  std::optional<pipeline::Slam> slam_;
  bool is_finished_ = false;
};

LoopCloser::LoopCloser(const Calibration& calibration, const LoopCloserOptions& options)
    : session_(
          library::at_border([&] { return std::make_unique<Session>(calibration, options); })) {}

LoopCloser::~LoopCloser() = default;

std::vector<LoopVerdict> LoopCloser::add(const OdometryFrame& keyframe) {
  return session_->add(keyframe);
}

std::vector<LoopVerdict> LoopCloser::finish() { return session_->finish(); }

std::vector<CorrectedPose> LoopCloser::poses() const { return session_->poses(); }

std::shared_ptr<const Map> LoopCloser::map() const { return session_->map(); }

}  // namespace samewhere
