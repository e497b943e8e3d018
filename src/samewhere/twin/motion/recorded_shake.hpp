#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include <samewhere/core/truth.hpp>
#include <samewhere/twin/motion/shake.hpp>

namespace samewhere::twin {

// How a real camera moved on its carrier: what a recorded trajectory has beyond its own smooth
// path. Steps, sway, looking around. Offsets along the heading of that path, its left and up, at
// most kMostShake_m; angles of the camera from its mean attitude on the way, at most
// kMostShake_rad.
enum ShakeChannel {
  kShakeForward,  // metres
  kShakeLeft,
  kShakeUp,
  kShakeYaw,  // radians, as in motion.hpp
  kShakePitch,
  kShakeRoll
};
inline constexpr int kShakeChannels = 6;
inline constexpr double kMostShake_m = 0.15;
inline constexpr double kMostShake_rad = 0.9;

class RecordedShake {
 public:
  RecordedShake() = default;  // none
  // Of a body whose axes may be any, in a world whose z is up, that walks: at least 10 s, no gap of
  // more than 0.5 s, and on half of the way at 0.2 m/s or faster. Throws InputError that says what
  // was expected.
  explicit RecordedShake(const core::Trajectory& trajectory);

  bool is_empty() const { return values_.empty(); }
  double duration_s() const;
  // Twice continuously differentiable. Before the first pose and after the last the recording runs
  // backwards, and forwards again.
  std::array<Jet, kShakeChannels> at(double stamp_s) const;

 private:
  using Values = Eigen::Matrix<double, kShakeChannels, 1>;
  std::vector<Values> values_;  // control points of a uniform cubic B-spline
};

}  // namespace samewhere::twin
