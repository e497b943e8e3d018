#pragma once

#include <cmath>

#include <samewhere/core/rig.hpp>
#include <samewhere/core/rigid3.hpp>
#include <samewhere/twin/building/building.hpp>
#include <samewhere/twin/building/surface.hpp>

namespace samewhere::twin {

inline constexpr int kNumThreads = 2;  // that compute the light in tests

// For tests: a room 6 m long (x), 4 m wide and 3 m high around the origin, with a square lamp of
// half a metre under the middle of the ceiling.
struct TestRoom {
  static constexpr float kHeight_m = 3.0F;
  static constexpr int kFloor = 0;  // index

  explicit TestRoom(const Colour& colour, float lamp_radiance = 10.0F) {
    const Eigen::Vector3f x = Eigen::Vector3f::UnitX();
    const Eigen::Vector3f y = Eigen::Vector3f::UnitY();
    const Eigen::Vector3f z = Eigen::Vector3f::UnitZ();
    const Material paint{.finish = Finish::kPaint, .colour = colour, .second = colour};
    add({-3, -2, 0}, x, y, {6, 4}, paint);
    add({-3, 2, kHeight_m}, x, -y, {6, 4}, paint);
    add({-3, 2, 0}, x, z, {6, kHeight_m}, paint);
    add({3, -2, 0}, -x, z, {6, kHeight_m}, paint);
    add({3, 2, 0}, -y, z, {4, kHeight_m}, paint);
    add({-3, -2, 0}, y, z, {4, kHeight_m}, paint);
    const Material lamp{
        .finish = Finish::kLamp, .colour = Colour::Ones(), .radiance = lamp_radiance};
    add({-0.25F, 0.25F, kLamp_m}, x, -y, {0.5F, 0.5F}, lamp);
  }

  void add(const Eigen::Vector3f& corner_m, const Eigen::Vector3f& right, const Eigen::Vector3f& up,
           const Eigen::Vector2f& size_m, const Material& material) {
    building.rectangles.push_back(
        {.corner_m = corner_m, .right = right, .up = up, .size_m = size_m, .material = material});
  }

  static constexpr float kLamp_m = kHeight_m - 0.02F;
  Building building;
};

inline constexpr core::PinholeRadtan kSmallCamera = {.width_px = 161,
                                                     .height_px = 121,
                                                     .fx_px = 130.0,
                                                     .fy_px = 130.0,
                                                     .cx_px = 80.0,
                                                     .cy_px = 60.0,
                                                     .k1 = 0.02};

// A camera at a point that looks level along a heading.
inline core::Rigid3 looking(const Eigen::Vector3d& position_m, double heading_rad) {
  Eigen::Matrix3d world_from_camera;
  world_from_camera.col(0) = Eigen::Vector3d(std::sin(heading_rad), -std::cos(heading_rad), 0.0);
  world_from_camera.col(1) = -Eigen::Vector3d::UnitZ();
  world_from_camera.col(2) = Eigen::Vector3d(std::cos(heading_rad), std::sin(heading_rad), 0.0);
  return {Eigen::Quaterniond(world_from_camera), position_m};
}

}  // namespace samewhere::twin
