#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <samewhere/core/random.hpp>
#include <samewhere/twin/building/presets.hpp>
#include <samewhere/twin/building/presets_route.hpp>

namespace samewhere::twin {

// What the tests of presets share.

inline Spec spec_of(const std::string& preset, std::uint64_t seed = 3, double similarity = 0.8) {
  return {.preset = preset, .seed = seed, .similarity = similarity};
}

inline Eigen::Vector3f random_direction(core::Random& random) {
  return Eigen::Vector3d(random.gaussian(), random.gaussian(), random.gaussian()).cast<float>();
}

inline bool holds(const Area& area, const Eigen::Vector3f& point_m, float margin_m) {
  return (point_m.array() >= area.low_m.array() - margin_m).all() &&
         (point_m.array() <= area.high_m.array() + margin_m).all();
}

inline std::string name_of(const Building& building, const Rectangle& r) {
  return r.object < 0 ? "a surface" : building.objects[static_cast<std::size_t>(r.object)].name;
}

// Points of the route at most this far apart.
inline std::vector<Eigen::Vector3d> points_along(const Route& route, double step_m) {
  const auto corners = points_of(route);
  std::vector<Eigen::Vector3d> points{corners.front()};
  for (std::size_t i = 1; i < corners.size(); ++i) {
    const Eigen::Vector3d way_m = corners[i] - corners[i - 1];
    const auto num_steps = static_cast<int>(std::ceil(way_m.norm() / step_m));
    for (int k = 1; k <= num_steps; ++k) points.push_back(corners[i - 1] + way_m * k / num_steps);
  }
  return points;
}

inline std::string test_name(const testing::TestParamInfo<std::string>& preset) {
  std::string name = preset.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

// Instantiated with all presets in presets_test.cpp.
class AnyPreset : public testing::TestWithParam<std::string> {};

}  // namespace samewhere::twin
