#pragma once

// For tests and the benchmark: cameras on a walk past a cloud of points, and what they see.

#include <cmath>
#include <limits>

#include <samewhere/core/random.hpp>
#include <samewhere/optimize/bundle.hpp>

namespace samewhere::optimize {

struct SceneSettings {
  int num_cameras = 6;
  int num_points = 200;
  int num_fixed = 1;
  double noise_px = 0.5;
  bool has_depth = true;
};

inline core::Rigid3 camera_on_walk(int i) {
  const core::Rigid3 world_from_camera{core::exp_so3({0.0, 0.03 * i, 0.0}), {0.15 * i, 0.0, 0.0}};
  return inverse(world_from_camera);
}

// Cameras and points at their true places; observations with noise, right_x where asked for.
inline BundleProblem test_scene(const SceneSettings& settings, core::Random& random) {
  BundleProblem scene;
  for (int i = 0; i < settings.num_cameras; ++i) {
    scene.cameras.push_back(
        {camera_on_walk(i), {640, 480, 500, 505, 320, 240}, 0.075, i < settings.num_fixed});
  }
  const double end_m = 0.15 * settings.num_cameras;
  for (int i = 0; i < settings.num_points; ++i) {
    scene.points_in_world.emplace_back(random.uniform(-1.5, 1.5 + end_m), random.uniform(-1.0, 1.0),
                                       random.uniform(2.0, 5.0));
  }
  for (int c = 0; c < settings.num_cameras; ++c) {
    for (int i = 0; i < settings.num_points; ++i) {
      const Eigen::Vector3d p =
          camera_on_walk(c) * scene.points_in_world[static_cast<std::size_t>(i)];
      const Eigen::Vector2d pixel(500 * p.x() / p.z() + 320, 505 * p.y() / p.z() + 240);
      if (p.z() < 0.5 || pixel.x() < 0 || pixel.x() > 639 || pixel.y() < 0 || pixel.y() > 479)
        continue;
      const auto noise = [&] { return settings.noise_px * random.gaussian(); };
      const double right_x = pixel.x() - 500 * 0.075 / p.z() + noise();
      scene.observations.push_back(
          {c,
           i,
           {pixel + Eigen::Vector2d(noise(), noise()),
            settings.has_depth ? right_x : std::numeric_limits<double>::quiet_NaN(), 1.0}});
    }
  }
  return scene;
}

// Free poses and points moved by random errors of these sizes (metres and radians; metres).
inline BundleProblem disturbed(BundleProblem scene, double of_poses, double of_points,
                               core::Random& random) {
  for (auto& camera : scene.cameras) {
    if (camera.is_fixed) continue;
    core::Vector6d error;
    for (int i = 0; i < 6; ++i) error(i) = of_poses * random.gaussian();
    camera.camera_from_world = core::exp_r3so3(error) * camera.camera_from_world;
  }
  for (auto& point : scene.points_in_world) {
    point += of_points * Eigen::Vector3d(random.gaussian(), random.gaussian(), random.gaussian());
  }
  return scene;
}

}  // namespace samewhere::optimize
