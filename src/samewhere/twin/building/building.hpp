#pragma once

#include <string>
#include <vector>

#include <samewhere/core/rigid3.hpp>
#include <samewhere/twin/building/surface.hpp>

namespace samewhere::twin {

// A part of a building that may have look-alikes: units of one kind are built alike, turned and
// moved as a whole. What stands at a point of one has its counterpart at the same point of the
// other.
struct Unit {
  int kind = 0;
  core::Rigid3 world_from_unit;  // z stays up
};

// A piece of space with a name: where a camera in it is. Corners in the world.
struct Area {
  std::string name;  // "corridor", "room 302", "stairs"
  int floor = 0;     // 0 is the lowest
  int unit = 0;      // index
  Eigen::Vector3f low_m = Eigen::Vector3f::Zero();
  Eigen::Vector3f high_m = Eigen::Vector3f::Zero();
};

// A thing that a person would name.
struct Object {
  std::string name;  // "door plate 302", "poster"
  int unit = 0;      // index
  // Nothing else in the building looks like it: recognizing it determines the place.
  bool is_unique = false;
};

// Everything there is to see, and what it means.
struct Building {
  std::vector<Rectangle> rectangles;
  std::vector<Unit> units;
  std::vector<Area> areas;
  std::vector<Object> objects;
};

}  // namespace samewhere::twin
