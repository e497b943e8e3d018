#pragma once

#include <variant>
#include <vector>

#include <Eigen/Core>

namespace samewhere::twin {

// In a straight line to a point of the floor. Corners between straight lines are rounded when they
// are walked (motion.hpp); z changes linearly along the line: stairs, ramps, lifts.
struct WalkTo {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
};

// On the spot, by the shorter way; a half turn goes left. Heading 0 looks along +x, and it grows
// counter-clockwise.
struct TurnTo {
  double heading_rad = 0.0;
};

struct Stand {
  double duration_s = 0.0;
};

// Stands with the lens covered. Afterwards the next visit of the building begins.
struct Darken {
  double duration_s = 0.0;
};

using Step = std::variant<WalkTo, TurnTo, Stand, Darken>;

enum class Carrier { kWalker, kRobot };

// What a carrier with a camera does in a building, one step after the other.
struct Route {
  Eigen::Vector3d start_m = Eigen::Vector3d::Zero();
  double start_heading_rad = 0.0;
  std::vector<Step> steps;
  Carrier carrier = Carrier::kWalker;
  double speed_m_s = 1.3;
  double camera_height_m = 1.5;
  // The camera looks left and right by up to this much (on ways along x or y): at the same things
  // wherever it passes again, this way or the other.
  double look_aside_rad = 0.0;
};

}  // namespace samewhere::twin
