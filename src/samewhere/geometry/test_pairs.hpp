#pragma once

// For tests: what two cameras see of points whose position is known.

#include <functional>

#include <samewhere/core/random.hpp>
#include <samewhere/core/rigid3.hpp>
#include <samewhere/geometry/ray_pairs.hpp>

namespace samewhere::geometry {

struct TestScene {
  core::Rigid3 second_from_first;
  int num_points = 200;
  double noise_px = 0.0;
  double outlier_ratio = 0.0;
  // Depth along the ray (x, y, 1) of the first camera.
  std::function<double(core::Random& random, double x, double y)> depth_m;
};

constexpr double kTestFocal_px = 500.0;

// Points between 2 and 8 m away.
inline double general_depth(core::Random& random, double, double) {
  return random.uniform(2.0, 8.0);
}

// Points of the plane normal . x = 1.
inline std::function<double(core::Random&, double, double)> plane_depth(
    const Eigen::Vector3d& normal) {
  return [normal](core::Random&, double x, double y) {
    return 1.0 / normal.dot(Eigen::Vector3d(x, y, 1.0));
  };
}

// A motion of a tenth to half a metre in any direction that turns by up to 0.2 rad.
inline core::Rigid3 random_motion(core::Random& random) {
  const auto vector = [&] {
    return Eigen::Vector3d(random.gaussian(), random.gaussian(), random.gaussian()).normalized();
  };
  return {core::exp_so3(random.uniform(0.0, 0.2) * vector()), random.uniform(0.1, 0.5) * vector()};
}

inline Eigen::Vector3d with_noise(const Eigen::Vector3d& point, double noise_px,
                                  core::Random& random) {
  const Eigen::Vector3d error(random.gaussian(), random.gaussian(), 0.0);
  return (point / point.z() + noise_px / kTestFocal_px * error).normalized();
}

inline RayPairs test_pairs(const TestScene& scene, core::Random& random) {
  RayPairs pairs{{}, {}, kTestFocal_px};
  for (int i = 0; i < scene.num_points; ++i) {
    const double x = random.uniform(-0.6, 0.6);
    const double y = random.uniform(-0.45, 0.45);
    const Eigen::Vector3d in_first = scene.depth_m(random, x, y) * Eigen::Vector3d(x, y, 1.0);
    const bool is_outlier = random.uniform() < scene.outlier_ratio;
    const Eigen::Vector3d in_second =
        is_outlier ? Eigen::Vector3d(random.uniform(-0.6, 0.6), random.uniform(-0.45, 0.45), 1.0)
                   : scene.second_from_first * in_first;
    pairs.first.push_back(with_noise(in_first, scene.noise_px, random));
    pairs.second.push_back(with_noise(in_second, scene.noise_px, random));
  }
  return pairs;
}

// Angles between the rotations and between the directions of the translations, the larger.
inline double motion_error_rad(const core::Rigid3& a, const core::Rigid3& b) {
  const double turn_rad = core::angle_rad(a.rotation.conjugate() * b.rotation);
  const double direction_rad =
      std::atan2(a.translation.cross(b.translation).norm(), a.translation.dot(b.translation));
  return std::max(turn_rad, direction_rad);
}

}  // namespace samewhere::geometry
