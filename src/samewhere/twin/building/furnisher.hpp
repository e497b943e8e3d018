#pragma once

#include <samewhere/twin/building/building.hpp>
#include <samewhere/twin/building/shapes.hpp>
#include <samewhere/twin/building/style.hpp>

namespace samewhere::twin {

class Piece;

// An upright plane from its left to its right end, as seen from the front. Metres, in the
// coordinates of the unit.
struct Wall {
  Eigen::Vector2f from_m = Eigen::Vector2f::Zero();
  Eigen::Vector2f to_m = Eigen::Vector2f::UnitX();
  float floor_m = 0.0F;  // height of the floor before it
  float ceiling_m = 2.6F;

  float length_m() const { return (to_m - from_m).norm(); }
};

// Where on a wall the middle of a thing is.
struct Place {
  Wall wall;
  float along_m = 0.0F;  // from the left end of the wall
};

// Where on the floor a thing stands; its front looks along the heading.
struct Spot {
  Eigen::Vector3f position_m = Eigen::Vector3f::Zero();
  float heading_rad = 0.0F;  // from the x axis towards the y axis
};

enum class WallFinish { kBlocks, kPlaster, kConcrete, kBrick };
enum class FloorFinish { kCarpet, kTiles, kConcrete, kWood };
enum class CeilingFinish { kTiles, kPlaster, kConcrete };
enum class Daylight { kBlinds, kView };
enum class VentKind { kGrille, kSlot, kRound };

// What a ceiling lamp is.
struct LampFitting {
  LampFace face = LampFace::kRibbed;
  Eigen::Vector2f size_m{1.2F, 0.3F};
  float drop_m = 0.0F;     // hangs this far below the ceiling
  float usual_m2 = 0.36F;  // gives as much light as so much of a usual lamp
};

enum class Pictogram { kArrow, kStairs, kLift, kToilet, kExtinguisher };

// A rack of shelves for pallets.
struct RackSize {
  float length_m = 2.7F;
  int num_levels = 3;
};

// Puts walls and things of real dimensions into one unit of a building. Looks are half common and
// half own (Style): each call draws for itself, so that the n-th thing of a unit has its
// counterpart in the n-th thing of its look-alikes. Takes the coordinates of the unit; the unit
// must be in the building already. Things that a person would name become objects; what hangs
// nowhere else (numbers, own prints, big stains) is marked unique.
class Furnisher {
 public:
  Furnisher(Building& building, int unit, const Style& style, const LightSetting& light = {});

  // The thing that would come next is left out; what follows stays in step with the look-alikes.
  void skip_thing() { ++num_things_; }
  std::uint64_t num_things() const { return num_things_; }

  // From `low_m` to `high_m`, heights in the unit as the wall's floor is.
  void add_wall(const Wall& wall, float low_m, float high_m, WallFinish finish);
  void add_floor(const Eigen::Vector2f& low_m, const Eigen::Vector2f& high_m, float z_m,
                 FloorFinish finish);
  void add_ceiling(const Eigen::Vector2f& low_m, const Eigen::Vector2f& high_m, float z_m,
                   CeilingFinish finish);
  void add_skirting(const Wall& wall, float from_along_m, float to_along_m);

  // Where a wall meets the ceiling: `width_m` along the ceiling, `height_m` down the wall.
  void add_cornice(const Wall& wall, float width_m, float height_m);

  // A leaf of 0.9 m x 2.05 m, its frame at most 0.07 m around it, the plate to the right of it.
  void add_door(const Place& place, int number);
  // 1.8 m x 2.05 m, for a fire door across a corridor's end.
  void add_double_door(const Place& place);
  void add_lift_door(const Place& place, int floor);
  void add_floor_number(const Place& place, int floor);
  void add_bay_number(const Place& place, int bay);  // large, above doors
  void add_notice_board(const Place& place);         // 1.18 m x 0.9 m
  void add_framed_poster(const Place& place);        // 0.64 m x 0.88 m
  void add_extinguisher(const Place& place);
  void add_cabinet(const Place& place);  // 0.9 m wide, 0.32 m deep
  void add_switch(const Place& place);
  void add_notice(const Place& place);     // a sheet of paper, taped to the wall
  void add_coat_rack(const Place& place);  // 1.0 m wide, 0.24 m deep, with coats and bags
  void add_leaflets(const Place& place);   // 0.72 m x 0.92 m, 0.05 m deep
  void add_low_shelf(const Place& place);  // 0.88 m wide, 0.3 m deep, small things on it
  void add_crates(const Place& place);     // 0.5 m wide, 0.38 m deep, up to 0.9 m high
  void add_window(const Place& place, Daylight daylight);  // 1.6 m wide at most, sill 0.87 m up
  void add_radiator(const Place& place);                   // 1.2 m wide, 0.12 m deep
  // Along the whole wall, 0.9 m up; higher by `rise_m` at its right end.
  void add_handrail(const Wall& wall, float rise_m = 0.0F);
  // Its top this far below the ceiling.
  void add_cable_duct(const Wall& wall, float below_m = 0.17F);
  // A run of two or three pipes along the whole wall, the lowest this far above the floor.
  void add_pipes(const Wall& wall, float height_m);
  void add_sign(const Place& place, Pictogram pictogram);

  void add_chair(const Spot& spot);
  void add_table(const Spot& spot);  // 1.2 m x 0.7 m
  void add_desk(const Spot& spot);   // 1.6 m x 0.8 m with screen and drawers; one sits behind it
  void add_plant(const Spot& spot);
  void add_bin(const Spot& spot);
  void add_sofa(const Spot& spot);   // 1.7 m x 0.8 m
  void add_shelf(const Spot& spot);  // 0.9 m wide, 0.35 m deep, with books and folders
  // Two bays or more, 1.1 m deep; its goods are seen from both sides.
  void add_rack(const Spot& spot, const RackSize& size);
  void add_pallet(const Spot& spot);  // 1.2 m x 0.8 m with cartons

  void add_ceiling_lamp(const Eigen::Vector2f& middle_m, const LampFitting& fitting,
                        float ceiling_m);
  void add_ceiling_vent(const Eigen::Vector2f& middle_m, VentKind kind, float ceiling_m);
  // Hangs across a corridor: read by people that walk along `heading_rad` or against it.
  void add_exit_sign(const Eigen::Vector2f& middle_m, float heading_rad, float ceiling_m);
  void add_smoke_detector(const Eigen::Vector2f& middle_m, float ceiling_m);
  void add_high_bay_lamp(const Eigen::Vector2f& middle_m, float ceiling_m);

 private:
  void add_number(const Place& place, const std::string& name, int number, const Box& board);
  // The next thing, at a stand in the unit.
  Piece piece_at(const Stance& stand);
  Piece piece_at(const Wall& wall);
  Piece piece_at(const Place& place);
  Piece piece_at(const Spot& spot);
  Piece piece_below(const Eigen::Vector2f& middle_m, float ceiling_m);

  Building& building_;
  int unit_;
  Style style_;
  LightSetting light_;
  Palette palette_;
  std::uint64_t num_things_ = 0;
};

}  // namespace samewhere::twin
