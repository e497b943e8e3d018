#include <algorithm>

#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/interrupt.hpp>
#include <samewhere/core/progress.hpp>
#include <samewhere/core/random.hpp>
#include <samewhere/core/tum_file.hpp>
#include <samewhere/twin/front/camera.hpp>
#include <samewhere/twin/front/walkthrough.hpp>
#include <samewhere/twin/motion/inertial.hpp>

namespace samewhere::twin {
namespace {

const Spec& require_renderer(const Spec& spec) {
  if (can_render()) return spec;
  throw core::InputError(fmt::format(
      "twin:{}: built without the rendered buildings (SAMEWHERE_TWIN=OFF); expected a recording",
      spec.preset));
}

std::shared_ptr<const core::Rig> rig_for(const Spec& spec) {
  core::Rig rig{.cameras = {kTwinCamera},
                .body_from_camera = {core::Rigid3{}},
                .imu = imu_description(InertialNoise{})};
  if (spec.sensors == Sensors::kStereo) {
    core::Rigid3 right;
    right.translation.x() = kStereoBaseline_m;
    rig.cameras.push_back(kTwinCamera);
    rig.body_from_camera.push_back(right);
  }
  return std::make_shared<const core::Rig>(std::move(rig));
}

Walk walk_of(const Motion& motion, int num_frames) {
  Walk walk{.poses = motion.frames(kFrameRate_hz), .visit_of_frame = {}};
  if (num_frames > 0) {
    walk.poses.resize(std::min(walk.poses.size(), static_cast<std::size_t>(num_frames)));
  }
  for (const auto& pose : walk.poses) {
    walk.visit_of_frame.push_back(motion.visit_at(pose.stamp_s).value_or(kDark));
  }
  return walk;
}

RecordedShake recorded_shake(const std::string& file) {
  if (file.empty()) return {};
  try {
    return RecordedShake(core::read_tum(file, core::MoreColumns::kSkipped));
  } catch (const core::InputError& error) {
    const std::string_view reason = error.what();
    throw core::InputError(reason.find(file) == std::string_view::npos
                               ? fmt::format("twin.shake: {}: {}", file, reason)
                               : fmt::format("twin.shake: {}", reason));
  }
}

Motion motion_through(const World& world, const Spec& spec, const RecordedShake& recorded) {
  const std::uint64_t seed = core::seed_of(spec.seed, "twin.motion", 0);
  if (spec.stray_m == 0.0) return {world.route, seed, {}, recorded};
  std::vector<RayScene> visits;
  for (const auto& building : world.visits) visits.emplace_back(building.rectangles);
  const Room room_m = [&](const Eigen::Vector3d& floor_m, double heading_rad) {
    double least_m = spec.stray_m;
    for (const auto& rays : visits)
      least_m = std::min(least_m, room_in(rays, floor_m, heading_rad, spec.stray_m));
    return least_m;
  };
  return {world.route, seed, {.most_m = spec.stray_m, .room_m = room_m}, recorded};
}

std::uint64_t imu_seed(const Spec& spec) { return core::seed_of(spec.seed, "twin.imu", 0); }

std::vector<Person> people_in(const World& world, const Spec& spec) {
  std::vector<std::vector<Eigen::Vector3d>> paths_m;
  for (const auto& path : world.paths_of_people) paths_m.push_back(path.points_m);
  return people_on(paths_m, spec.people, core::seed_of(spec.seed, "twin.people", 0));
}

}  // namespace

Walkthrough::Walkthrough(const Spec& spec, const Config& config)
    : spec_(require_renderer(spec)),
      name_(fmt::format("{}-seed{}", spec.preset, spec.seed)),
      world_(build_world(spec)),
      motion_(motion_through(world_, spec, recorded_shake(config.shake))),
      rig_(rig_for(spec)),
      walk_(walk_of(motion_, config.num_frames)),
      people_(people_in(world_, spec)),
      imu_(inertial_samples(motion_, InertialNoise{}, imu_seed(spec))) {
  rays_.reserve(world_.visits.size());
  for (const auto& building : world_.visits) {
    rays_.emplace_back(building.rectangles);
    visits_.push_back({.building = &building, .rays = &rays_.back()});
  }
}

std::span<const core::ImuSample> Walkthrough::imu_since_last(int frame) const {
  // stamps of frames and samples that mean the same moment may differ in the last bits
  constexpr double kTolerance_s = 1e-6;
  const auto first_after = [&](double stamp_s) {
    return std::partition_point(imu_.begin(), imu_.end(), [&](const core::ImuSample& sample) {
      return sample.stamp_s <= stamp_s + kTolerance_s;
    });
  };
  const auto first = frame == 0 ? imu_.begin() : first_after(stamp_s(frame - 1));
  return {first, first_after(stamp_s(frame))};
}

core::Frame Walkthrough::frame_without_pictures(int index) const {
  const std::span<const core::ImuSample> imu = imu_since_last(index);
  return {.id = core::FrameId(static_cast<std::uint64_t>(index)),
          .stamp_s = stamp_s(index),
          .name = fmt::format("{} frame {}", name_, index),
          .rig = rig_,
          .images = {},
          .imu_since_last = {imu.begin(), imu.end()}};
}

std::vector<WheelSample> Walkthrough::wheels() const {
  if (motion_.carrier() != Carrier::kRobot) return {};
  std::vector<WheelSample> wheels =
      wheel_samples(motion_, WheelNoise{}, core::seed_of(spec_.seed, "twin.wheels", 0));
  const double end_s = stamp_s(num_frames() - 1);
  std::erase_if(wheels, [&](const WheelSample& sample) { return sample.stamp_s > end_s; });
  return wheels;
}

std::vector<core::InertialTruth> Walkthrough::inertial_truth() const {
  std::vector<double> stamps_s;
  for (const auto& pose : walk_.poses) stamps_s.push_back(pose.stamp_s);
  return twin::inertial_truth(motion_, inertial_biases(motion_, InertialNoise{}, imu_seed(spec_)),
                              stamps_s);
}

const WalkTruth& Walkthrough::truth(const WatchPairs& watch) const {
  if (!truth_) truth_ = truth_of(walk_, visits_, rig_->cameras.front(), watch);
  return *truth_;
}

const WalkTruth& watched_truth(const Walkthrough& walk) {
  std::optional<core::Progress> progress;
  return walk.truth([&](int num_labelled, int num_pairs) {
    if (!progress) progress.emplace("pairs of frames labelled", num_pairs);
    progress->update(num_labelled);
    core::stop_if_interrupted();
  });
}

}  // namespace samewhere::twin
