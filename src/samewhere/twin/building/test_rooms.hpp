#pragma once

#include <cmath>
#include <string>
#include <vector>

#include <samewhere/core/rig.hpp>
#include <samewhere/core/rigid3.hpp>
#include <samewhere/twin/building/building.hpp>

// Small buildings for tests, built by hand.
namespace samewhere::twin::test {

// 62.7 degrees wide.
inline constexpr core::PinholeRadtan kCamera{.width_px = 640,
                                             .height_px = 480,
                                             .fx_px = 525.0,
                                             .fy_px = 525.0,
                                             .cx_px = 319.5,
                                             .cy_px = 239.5};

// A level camera; heading 0 looks along x, a quarter turn along y.
inline core::Rigid3 looking(const Eigen::Vector3d& position_m, double heading_rad) {
  Eigen::Matrix3d world_from_camera;
  world_from_camera << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(heading_rad, Eigen::Vector3d::UnitZ()));
  return {turn * Eigen::Quaterniond(world_from_camera), position_m};
}

inline core::Rigid3 turned_and_moved(double turned_rad, const Eigen::Vector3d& moved_m) {
  return {Eigen::Quaterniond(Eigen::AngleAxisd(turned_rad, Eigen::Vector3d::UnitZ())), moved_m};
}

// The insides of a box: four walls, floor, ceiling.
inline std::vector<Rectangle> inside_of(const Eigen::Vector3f& size) {
  using Eigen::Vector3f;
  const Vector3f x = Vector3f::UnitX();
  const Vector3f y = Vector3f::UnitY();
  const Vector3f z = Vector3f::UnitZ();
  return {
      {.corner_m = {0, 0, 0}, .right = y, .up = z, .size_m = {size.y(), size.z()}},
      {.corner_m = {size.x(), size.y(), 0}, .right = -y, .up = z, .size_m = {size.y(), size.z()}},
      {.corner_m = {size.x(), 0, 0}, .right = -x, .up = z, .size_m = {size.x(), size.z()}},
      {.corner_m = {0, size.y(), 0}, .right = x, .up = z, .size_m = {size.x(), size.z()}},
      {.corner_m = {0, 0, 0}, .right = x, .up = y, .size_m = {size.x(), size.y()}},
      {.corner_m = {0, size.y(), size.z()}, .right = x, .up = -y, .size_m = {size.x(), size.y()}}};
}

// Adds what is given in the unit's coordinates.
inline void add(Building& building, int unit, Rectangle r) {
  const core::Rigid3& world_from_unit =
      building.units[static_cast<std::size_t>(unit)].world_from_unit;
  const Eigen::Matrix3f turn = world_from_unit.rotation.toRotationMatrix().cast<float>();
  r.corner_m = turn * r.corner_m + world_from_unit.translation.cast<float>();
  r.right = turn * r.right;
  r.up = turn * r.up;
  building.rectangles.push_back(r);
}

inline constexpr float kRoomLength_m = 4.0F;
inline constexpr float kRoomWidth_m = 3.0F;
inline constexpr float kRoomHeight_m = 2.6F;

// A room of 4 m x 3 m as a new unit of kind 0: every surface has a pattern of its own, the same in
// all rooms, with `own_ratio` of what no other room has.
inline void add_room(Building& building, const core::Rigid3& world_from_unit, float own_ratio) {
  const int unit = static_cast<int>(building.units.size());
  building.units.push_back({.kind = 0, .world_from_unit = world_from_unit});
  const Eigen::Vector3f size(kRoomLength_m, kRoomWidth_m, kRoomHeight_m);
  std::uint32_t seed = 10;
  for (Rectangle r : inside_of(size)) {
    r.material = {.finish = Finish::kWall,
                  .pattern_seed = ++seed,
                  .own_pattern_seed = 100 * static_cast<std::uint32_t>(unit) + seed,
                  .own_ratio = own_ratio};
    add(building, unit, r);
  }
  const Eigen::Vector3f corner = world_from_unit.translation.cast<float>();
  const Eigen::Vector3f opposite = (world_from_unit * size.cast<double>()).cast<float>();
  building.areas.push_back({.name = "room " + std::to_string(unit),
                            .floor = unit,
                            .unit = unit,
                            .low_m = corner.cwiseMin(opposite),
                            .high_m = corner.cwiseMax(opposite)});
}

// Two rooms alike, one behind the other along x, with a wall of 10 cm between.
inline Building twin_rooms(float own_ratio) {
  Building building;
  add_room(building, {}, own_ratio);
  add_room(building, turned_and_moved(0.0, {kRoomLength_m + 0.1, 0.0, 0.0}), own_ratio);
  return building;
}

// A unique square plate in the middle of the far wall (x = 4) of a room, 1.3 m high.
inline void add_plate(Building& building, int unit, const std::string& name, float size_m) {
  Rectangle plate{
      .corner_m = {kRoomLength_m - 0.01F, 0.5F * (kRoomWidth_m + size_m), 1.3F - 0.5F * size_m},
      .right = -Eigen::Vector3f::UnitY(),
      .up = Eigen::Vector3f::UnitZ(),
      .size_m = {size_m, size_m},
      .object = static_cast<int>(building.objects.size()),
      .material = {.finish = Finish::kPlate, .number = unit}};
  building.objects.push_back({.name = name, .unit = unit, .is_unique = true});
  add(building, unit, plate);
}

}  // namespace samewhere::twin::test
