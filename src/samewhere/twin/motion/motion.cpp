#include <algorithm>
#include <array>
#include <cmath>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/random.hpp>
#include <samewhere/twin/motion/motion.hpp>
#include <samewhere/twin/motion/spline.hpp>

namespace samewhere::twin {
namespace {

constexpr double kStandingShare = 0.3;  // of looking around: a hand-held camera is never still

// Camera axes (x right, y down, z forward) in a world with z up.
Eigen::Quaterniond level_rotation(double yaw_rad) {
  Eigen::Matrix3d world_from_level;
  world_from_level.col(0) = Eigen::Vector3d(std::sin(yaw_rad), -std::cos(yaw_rad), 0.0);
  world_from_level.col(1) = -Eigen::Vector3d::UnitZ();
  world_from_level.col(2) = Eigen::Vector3d(std::cos(yaw_rad), std::sin(yaw_rad), 0.0);
  return Eigen::Quaterniond(world_from_level);
}

}  // namespace

// The drive's channels as functions of time.
struct Motion::Carried {
  std::array<Jet, DriveState::RowsAtCompileTime> channels;

  const Jet& operator[](DriveChannel channel) const { return channels[channel]; }
};

struct Motion::Position {
  Jet x, y, z;
};

struct Motion::Angles {
  Jet yaw, pitch, roll;
};

Motion::Motion(const Route& route, std::uint64_t seed, const Stray& stray,
               const RecordedShake& recorded)
    : carrier_(route.carrier),
      camera_height_m_(route.camera_height_m),
      look_aside_rad_(route.look_aside_rad) {
  core::require(std::isfinite(camera_height_m_), "a route's camera has a finite height");
  core::require(std::isfinite(look_aside_rad_), "a route looks aside by a finite angle");
  core::Random random(core::seed_of(seed, "twin.motion", 0));
  shake_ = camera_shake(route.carrier, random);
  drive_ = drive_along(route, random);
  if (!recorded.is_empty() && route.carrier == Carrier::kWalker) take_over(recorded, seed);
  if (stray.most_m <= 0.0 || route.carrier != Carrier::kWalker) return;
  core::Random astray(core::seed_of(seed, "twin.stray", 0));
  hold_elsewhere(stray.most_m, astray, shake_);
  step_aside(stray, astray, drive_);
}

// In place of the made-up steps and looks, from a moment on that the seed chooses.
void Motion::take_over(const RecordedShake& recorded, std::uint64_t seed) {
  shake_ = {.mean_pitch_rad = shake_.mean_pitch_rad, .slope_share = shake_.slope_share};
  recorded_ = recorded;
  core::Random random(core::seed_of(seed, "twin.recorded", 0));
  recorded_from_s_ = random.uniform(0.0, recorded.duration_s());
}

core::Rigid3 Motion::world_from_body(double stamp_s) const {
  const Position position = position_at(stamp_s);
  const Angles angles = angles_at(stamp_s);
  const Eigen::Quaterniond rotation = level_rotation(angles.yaw.value) *
                                      core::exp_so3({angles.pitch.value, 0.0, 0.0}) *
                                      core::exp_so3({0.0, 0.0, angles.roll.value});
  return {rotation.normalized(), {position.x.value, position.y.value, position.z.value}};
}

Eigen::Vector3d Motion::velocity_m_s(double stamp_s) const {
  const Position position = position_at(stamp_s);
  return {position.x.first, position.y.first, position.z.first};
}

Eigen::Vector3d Motion::acceleration_m_s2(double stamp_s) const {
  const Position position = position_at(stamp_s);
  return {position.x.second, position.y.second, position.z.second};
}

Eigen::Vector3d Motion::angular_velocity_rad_s(double stamp_s) const {
  const Angles angles = angles_at(stamp_s);
  const Eigen::Quaterniond unpitch = core::exp_so3({-angles.pitch.value, 0.0, 0.0});
  const Eigen::Quaterniond unroll = core::exp_so3({0.0, 0.0, -angles.roll.value});
  const Eigen::Vector3d of_yaw(0.0, -angles.yaw.first, 0.0);  // up is -y of the level camera
  const Eigen::Vector3d of_pitch(angles.pitch.first, 0.0, 0.0);
  const Eigen::Vector3d of_roll(0.0, 0.0, angles.roll.first);
  return unroll * (unpitch * of_yaw + of_pitch) + of_roll;
}

Eigen::Vector3d Motion::floor_position_m(double stamp_s) const {
  const Carried carried = carried_at(stamp_s);
  return {carried[kDriveX].value, carried[kDriveY].value, carried[kDriveZ].value};
}

double Motion::heading_rad(double stamp_s) const {
  return carried_at(stamp_s)[kDriveHeading].value;
}

std::optional<int> Motion::visit_at(double stamp_s) const {
  int visit = 0;
  for (const Darkness& darkness : drive_.darkness) {
    if (stamp_s < darkness.begin_s) break;
    if (stamp_s < darkness.end_s) return std::nullopt;
    ++visit;
  }
  return visit;
}

core::Trajectory Motion::frames(double frame_rate_hz) const {
  core::require(frame_rate_hz > 0.0, "frames come at a rate above zero");
  core::Trajectory trajectory;
  for (int k = 0; k / frame_rate_hz <= duration_s(); ++k) {
    trajectory.push_back({k / frame_rate_hz, world_from_body(k / frame_rate_hz)});
  }
  return trajectory;
}

Motion::Carried Motion::carried_at(double stamp_s) const {
  const double last = static_cast<double>(drive_.states.size() - 1);
  // two steps beyond either end all control points are the same
  const double knot = std::clamp(stamp_s / kDriveStep_s, -2.0, last + 2.0);
  const double begin = std::floor(knot);
  const Eigen::Matrix<double, 3, 4> weights = spline_weights(knot - begin);
  Eigen::Matrix<double, DriveState::RowsAtCompileTime, 3> sums;
  sums.setZero();
  for (int i = 0; i < 4; ++i) {
    const double control = std::clamp(begin - 1.0 + i, 0.0, last);
    sums += drive_.states[static_cast<std::size_t>(control)] * weights.col(i).transpose();
  }
  Carried carried;
  for (int channel = 0; channel < sums.rows(); ++channel) {
    carried.channels[static_cast<std::size_t>(channel)] = {
        sums(channel, 0), sums(channel, 1) / kDriveStep_s,
        sums(channel, 2) / (kDriveStep_s * kDriveStep_s)};
  }
  return carried;
}

Motion::Position Motion::position_at(double stamp_s) const {
  const Carried carried = carried_at(stamp_s);
  const Jet moving = carried[kDriveMoving];
  const auto recorded = recorded_.at(recorded_from_s_ + stamp_s);
  const Jet forward = moving * (sum_at(shake_.forward_m, stamp_s) + recorded[kShakeForward]);
  const Jet left = moving * (sum_at(shake_.left_m, stamp_s) + recorded[kShakeLeft]);
  const Jet up = moving * (sum_at(shake_.up_m, stamp_s) + recorded[kShakeUp]);
  const Jet cosine = cos(carried[kDriveHeading]);
  const Jet sine = sin(carried[kDriveHeading]);
  return {carried[kDriveX] + forward * cosine + -1.0 * (left * sine),
          carried[kDriveY] + forward * sine + left * cosine,
          carried[kDriveZ] + up + Jet{camera_height_m_}};
}

Motion::Angles Motion::angles_at(double stamp_s) const {
  const Carried carried = carried_at(stamp_s);
  const Jet moving = carried[kDriveMoving];
  const Jet looking = Jet{kStandingShare} + (1.0 - kStandingShare) * moving;
  const auto recorded = recorded_.at(recorded_from_s_ + stamp_s);
  const auto shaken = [&](const Waves& look, const Waves& shake, ShakeChannel channel) {
    return looking * (sum_at(look, stamp_s) + recorded[channel]) + moving * sum_at(shake, stamp_s);
  };
  // one swing in nine metres, of the place, not of the time; the same wall is seen on the way back
  constexpr double kSwingX_rad_m = 0.7;
  constexpr double kSwingY_rad_m = 0.55;
  const Jet way = cos(carried[kDriveHeading]) + sin(carried[kDriveHeading]);
  const Jet swing = way * sin(kSwingX_rad_m * carried[kDriveX] + kSwingY_rad_m * carried[kDriveY]);
  return {carried[kDriveLook] + look_aside_rad_ * swing +
              shaken(shake_.look_yaw_rad, shake_.yaw_rad, kShakeYaw),
          Jet{shake_.mean_pitch_rad} + shake_.slope_share * carried[kDriveSlope] +
              shaken(shake_.look_pitch_rad, shake_.pitch_rad, kShakePitch),
          shaken(shake_.look_roll_rad, shake_.roll_rad, kShakeRoll)};
}

}  // namespace samewhere::twin
