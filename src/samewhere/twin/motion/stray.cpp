#include <algorithm>
#include <array>
#include <cmath>

#include <samewhere/core/errors.hpp>
#include <samewhere/twin/building/angles.hpp>
#include <samewhere/twin/motion/stray.hpp>

namespace samewhere::twin {
namespace {

constexpr double kElbow_m = 0.35;  // kept free beside the camera
constexpr double kFeel_m = 0.05;   // from one feeler to the next
constexpr float kHead_m = 1.8F;
constexpr float kStep_m = 0.3F;  // people get over: a stair's step between two feelers
constexpr std::array<float, 5> kHeights_m = {0.25F, 0.6F, 1.0F, 1.4F, kHead_m};
constexpr std::array<double, 3> kAlongWay_m = {-0.25, 0.0, 0.25};  // a body is not a line
constexpr int kSettle_steps = 15;  // of a drive: from where there is no room until it is used

Eigen::Vector3d ahead(double heading_rad) {
  return {std::cos(heading_rad), std::sin(heading_rad), 0.0};
}

// Whether one cannot step from one point to the other, or not stand there.
bool is_in_the_way(const RayScene& rays, const Eigen::Vector3f& from_m,
                   const Eigen::Vector3f& to_m) {
  constexpr float kOverlap = 1.1F;  // nothing is missed between one step and the next
  for (const float height_m : kHeights_m) {
    const Eigen::Vector3f feeler_m = kOverlap * (to_m - from_m);
    if (rays.is_blocked({from_m + height_m * Eigen::Vector3f::UnitZ(), feeler_m})) return true;
  }
  // the top of a table lies between the heights, and beyond an edge there is nothing to stand on
  const auto below =
      rays.first_hit({to_m + kHead_m * Eigen::Vector3f::UnitZ(), -Eigen::Vector3f::UnitZ()});
  return !below || std::abs(below->reach - kHead_m) > kStep_m;
}

// As far as a line to the side from `from_m` is free.
double reach_aside(const RayScene& rays, const Eigen::Vector3d& from_m, double heading_rad,
                   double most_m) {
  const Eigen::Vector3d step_m = kFeel_m * ahead(heading_rad);
  Eigen::Vector3d here_m = from_m;
  double reached_m = 0.0;
  while (reached_m < most_m) {
    const Eigen::Vector3d next_m = here_m + step_m;
    if (is_in_the_way(rays, here_m.cast<float>(), next_m.cast<float>())) break;
    here_m = next_m;
    reached_m += kFeel_m;
  }
  return reached_m;
}

bool is_walking(const Drive& drive, std::size_t i) {
  constexpr double kStanding_m = 0.02;  // in one step of the drive
  if (i == 0 || i + 1 >= drive.states.size()) return false;
  return (drive.states[i + 1] - drive.states[i - 1]).head<2>().norm() > 2.0 * kStanding_m;
}

// The room at each state on one side; `side` is 1: left, -1: right.
std::vector<double> rooms_beside(const Stray& stray, const Drive& drive, double side) {
  std::vector<double> rooms_m(drive.states.size(), 0.0);
  for (std::size_t i = 0; i < rooms_m.size(); ++i) {
    if (!is_walking(drive, i)) continue;
    const DriveState& state = drive.states[i];
    rooms_m[i] = std::clamp(stray.room_m(state.head<3>(), state[kDriveHeading] + side * 0.5 * kPi),
                            0.0, stray.most_m);
  }
  return rooms_m;
}

// Of the values up to kSettle_steps away.
template <class Fold>
std::vector<double> folded(const std::vector<double>& values, const Fold& fold) {
  const auto last = static_cast<int>(values.size()) - 1;
  std::vector<double> all;
  for (int i = 0; i <= last; ++i)
    all.push_back(fold(std::max(0, i - kSettle_steps), std::min(last, i + kSettle_steps), i));
  return all;
}

// Never more than there is room for, and smooth: the mean, with the weights of a bell, of the least
// around each.
std::vector<double> smooth_below(const std::vector<double>& values) {
  const auto at = [](const std::vector<double>& v, int i) {
    return v[static_cast<std::size_t>(i)];
  };
  const std::vector<double> least = folded(values, [&](int first, int last, int) {
    return *std::min_element(values.begin() + first, values.begin() + last + 1);
  });
  return folded(least, [&](int first, int last, int middle) {
    double sum = 0.0;
    double weights = 0.0;
    for (int i = first; i <= last; ++i) {
      const double weight = 1.0 + std::cos(kPi * (i - middle) / (kSettle_steps + 1.0));
      sum += weight * at(least, i);
      weights += weight;
    }
    return sum / weights;
  });
}

}  // namespace

double room_in(const RayScene& rays, const Eigen::Vector3d& floor_m, double heading_rad,
               double most_m) {
  double room_m = most_m;
  for (const double along_m : kAlongWay_m) {
    const Eigen::Vector3d from_m = floor_m + along_m * ahead(heading_rad - 0.5 * kPi);
    room_m = std::min(room_m, reach_aside(rays, from_m, heading_rad, most_m + kElbow_m) - kElbow_m);
  }
  return std::max(room_m, 0.0);
}

void step_aside(const Stray& stray, core::Random& random, Drive& drive) {
  core::require(stray.most_m >= 0.0 && stray.room_m,
                "a lateral offset needs the free room beside the path");
  constexpr double kWaves_per_m = 0.05;
  constexpr double kDecided = 2.0;  // nearer to either side than to the middle, mostly
  const Waves waves = random_waves(random, 1.0, kWaves_per_m);
  const std::vector<double> left_m = smooth_below(rooms_beside(stray, drive, 1.0));
  const std::vector<double> right_m = smooth_below(rooms_beside(stray, drive, -1.0));
  double walked_m = 0.0;
  Eigen::Vector2d before_m = drive.states.front().head<2>();
  for (std::size_t i = 0; i < drive.states.size(); ++i) {
    DriveState& state = drive.states[i];
    walked_m += (state.head<2>() - before_m).norm();
    before_m = state.head<2>();
    const double share = std::tanh(kDecided * sum_at(waves, walked_m).value);
    const double aside_m = share * (share > 0.0 ? left_m[i] : right_m[i]);
    state.head<2>() += aside_m * ahead(state[kDriveHeading] + 0.5 * kPi).head<2>();
  }
}

void hold_elsewhere(double most_m, core::Random& random, CameraShake& shake) {
  constexpr double kWaves_hz = 0.045;
  const auto add = [&](double largest, Waves& waves) {
    const Waves slow = random_waves(random, largest * most_m / kLargestWobble, kWaves_hz);
    waves.insert(waves.end(), slow.begin(), slow.end());
  };
  add(20.0 * kDegree_rad, shake.look_yaw_rad);
  add(6.0 * kDegree_rad, shake.look_pitch_rad);
  add(0.25, shake.up_m);
}

}  // namespace samewhere::twin
