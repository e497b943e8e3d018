#pragma once

#include <numbers>

namespace samewhere::twin {

constexpr double kPi = std::numbers::pi;
constexpr float kPi_f = std::numbers::pi_v<float>;
constexpr double kDegree_rad = kPi / 180.0;

}  // namespace samewhere::twin
