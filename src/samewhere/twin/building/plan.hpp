#pragma once

#include <string>
#include <vector>

#include <samewhere/twin/building/building.hpp>
#include <samewhere/twin/building/furnisher.hpp>

namespace samewhere::twin {

// Where a unit stands: turned counter-clockwise by quarters about its origin, then moved.
struct Placement {
  int num_quarter_turns = 0;
  Eigen::Vector3f origin_m = Eigen::Vector3f::Zero();
};

// An axis-aligned piece of free space in the coordinates of its unit. Spaces that touch are open
// to each other.
struct Space {
  std::string name;
  int floor = 0;  // 0 is the lowest
  int unit = 0;   // index
  Eigen::Vector2f low_m = Eigen::Vector2f::Zero();
  Eigen::Vector2f high_m = Eigen::Vector2f::Zero();
  float floor_m = 0.0F;
  float ceiling_m = 2.6F;
  WallFinish walls = WallFinish::kPlaster;
  FloorFinish ground = FloorFinish::kCarpet;
  CeilingFinish above = CeilingFinish::kTiles;
};

// A part of one side of a space that no neighbour covers.
struct WallPiece {
  int side = 0;  // 0: at low y, 1: low x, 2: high y, 3: high x
  Wall wall;     // from floor to ceiling of the space
  float low_m = 0.0F;
  float high_m = 0.0F;

  // Neither a lintel nor a riser: things may stand before it.
  bool is_whole() const { return low_m == wall.floor_m && high_m == wall.ceiling_m; }
  float length_m() const { return (wall.to_m - wall.from_m).norm(); }
};

// A floor plan: free spaces, from which the walls, lintels and risers between them follow.
class Plan {
 public:
  // The index of the new unit.
  int add_unit(int kind, const Placement& placement);
  // The index of the new space. It may touch others, but not overlap them (ContractError).
  int add(const Space& space);

  const std::vector<Unit>& units() const { return units_; }
  const std::vector<Space>& spaces() const { return spaces_; }
  const Space& space(int index) const { return spaces_[static_cast<std::size_t>(index)]; }
  // Of one space, in the coordinates of its unit: side by side, each from left to right as seen
  // from within. The same to the last bit for twins whose neighbours are alike.
  std::vector<WallPiece> walls_of(int space) const;
  // One for each space, in the world.
  std::vector<Area> areas() const;

 private:
  const Placement& placement_of(const Space& space) const {
    return placements_[static_cast<std::size_t>(space.unit)];
  }

  std::vector<Unit> units_;
  std::vector<Placement> placements_;
  std::vector<Space> spaces_;
};

// The gap that a door leaves in a wall: 0.9 m wide, 2.05 m high and as deep as a wall. `middle_m`
// is the middle of the gap, `is_along_x` says which way one walks through.
Space doorway(const Space& like, const Eigen::Vector2f& middle_m, bool is_along_x);

// A stair with a half-landing, for storeys of 3 m: two flights of nine steps side by side.
namespace u_stair {
inline constexpr float kFlightWidth_m = 1.3F;
inline constexpr float kCore_m = 0.15F;  // the wall between the flights
inline constexpr float kWidth_m = 2.0F * kFlightWidth_m + kCore_m;
inline constexpr float kFlight_m = 8 * 0.28F;
inline constexpr float kLanding_m = 1.5F;  // depth of the half-landing
inline constexpr float kStorey_m = 3.0F;
}  // namespace u_stair

// One storey of it. It opens at y = corner_m.y() over kWidth_m from corner_m.x() on and reaches
// from there to greater y: the flight at greater x leads from floor_m to the half-landing, the one
// at smaller x from there to the next floor.
void add_u_stair(Plan& plan, const Space& like, const Eigen::Vector2f& corner_m);

// The way up: floor points in the unit of the stair from the foot of the first flight to the head
// of the second.
std::vector<Eigen::Vector3f> way_up(const Eigen::Vector2f& corner_m, float floor_m);

}  // namespace samewhere::twin
