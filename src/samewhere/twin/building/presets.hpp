#pragma once

#include <vector>

#include <Eigen/Core>

#include <samewhere/twin/building/building.hpp>
#include <samewhere/twin/building/route.hpp>
#include <samewhere/twin/building/spec.hpp>

namespace samewhere::twin {

// Floor points along which a person may walk to and fro, keeping to the right.
struct PersonPath {
  std::vector<Eigen::Vector3d> points_m;
};

// A building as it is at each visit, the way of the camera through it and of people that walk
// about.
struct World {
  std::vector<Building> visits;  // more than one where the route darkens
  Route route;
  std::vector<PersonPath> paths_of_people;
};

// The world of a preset. The same spec gives the same world. Throws InputError for a preset that
// list_presets() does not name.
World build_world(const Spec& spec);

}  // namespace samewhere::twin
