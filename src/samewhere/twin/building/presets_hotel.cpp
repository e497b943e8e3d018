#include <samewhere/twin/building/presets_dresser.hpp>
#include <samewhere/twin/building/presets_each.hpp>
#include <samewhere/twin/building/presets_route.hpp>

namespace samewhere::twin {
namespace {

constexpr int kNumHotelFloors = 5;
const Eigen::Vector2f kStairCorner_m = Eigen::Vector2f::Zero();
// the lanes towards the stair and away from it, 0.7 m from the walls
constexpr double kUp_m = u_stair::kWidth_m - 0.70;
constexpr double kDown_m = 0.70;

constexpr float kHalfLift_m = 0.57F;  // with its frame

struct Storey {
  int unit, landing, corridor;
};

Storey add_storey(Plan& plan, int floor) {
  const float z_m = u_stair::kStorey_m * static_cast<float>(floor);
  const int unit = plan.add_unit(0, {.origin_m = {0.0F, 0.0F, z_m}});
  constexpr float kLanding_m = 1.5F;
  constexpr float kCorridor_m = 13.0F;
  return {.unit = unit,
          .landing = plan.add({.name = "landing",
                               .floor = floor,
                               .unit = unit,
                               .low_m = {0.0F, -kLanding_m},
                               .high_m = {u_stair::kWidth_m, 0.0F},
                               .ground = FloorFinish::kTiles}),
          .corridor = plan.add({.name = "corridor",
                                .floor = floor,
                                .unit = unit,
                                .low_m = {0.0F, -kLanding_m - kCorridor_m},
                                .high_m = {u_stair::kWidth_m, -kLanding_m}})};
}

// From this floor to the next. There is one more below and above, so that every floor has a flight
// down and a flight up.
int add_stair(Plan& plan, int floor) {
  const float z_m = u_stair::kStorey_m * static_cast<float>(floor);
  const int unit = plan.add_unit(1, {.origin_m = {0.0F, 0.0F, z_m}});
  add_u_stair(plan,
              {.name = "stairs",
               .floor = floor,
               .unit = unit,
               .walls = WallFinish::kBrick,
               .ground = FloorFinish::kTiles},
              kStairCorner_m);
  return unit;
}

void furnish_storey(Draft& draft, const Storey& storey, int floor) {
  Dresser dresser(draft, storey.unit);
  dresser.number_from(100 * (floor + 1) + 1);
  const Place number{dresser.wall_of(storey.landing, 3), 0.6F};
  const Place extinguisher{dresser.wall_of(storey.corridor, 1), 0.4F};
  const Wall side = dresser.wall_of(storey.corridor, 3);
  constexpr float kBeforeLastDoor_m = 10.68F;
  constexpr float kCorner_m = 0.8F;
  dresser.keep_free(number, 0.5F);
  dresser.keep_free(extinguisher, 0.3F);
  dresser.keep_free({side, kBeforeLastDoor_m}, 0.8F);
  const Wall end = dresser.wall_of(storey.corridor, 0);
  dresser.keep_free({end, 0.5F * kCorner_m}, kCorner_m);
  const auto doors = Use::kDoors;
  dresser.dress(storey.corridor,
                {.sides = {Use::kWindows, doors, Use::kBare, doors}, .max_depth_m = 0.05F});
  dresser.dress(storey.landing, {.sides = {Use::kBare, Use::kNothing, Use::kBare, Use::kPlain},
                                 .max_depth_m = 0.05F});
  Furnisher& furnisher = dresser.furnisher();
  furnisher.add_floor_number(number, floor);
  const Wall lift = dresser.wall_of(storey.landing, 1);
  furnisher.add_lift_door({lift, 0.7F}, floor);
  dresser.add_skirting(lift, {{0.7F - kHalfLift_m, 0.7F + kHalfLift_m}});
  // obstacles stand off the paths
  furnisher.add_plant(spot_before(end, 0.45F, 0.45F));
  furnisher.add_chair(spot_before(side, kBeforeLastDoor_m, 0.35F));
  furnisher.add_extinguisher(extinguisher);
}

Eigen::Vector3d on_floor(double x_m, double y_m, int floor) {
  return {x_m, y_m, static_cast<double>(u_stair::kStorey_m) * floor};
}

// Out along the corridor, around and back.
void walk_out_and_back(Route& route, int floor, double stretch_m, double back_m) {
  walk(route, {on_floor(kDown_m, -stretch_m, floor), on_floor(kUp_m, -stretch_m, floor),
               on_floor(kUp_m, -back_m, floor)});
}

}  // namespace

// Five floors, 3 m each, around a stair with half-landings; on each a corridor 2.75 m wide and
// 14.5 m long.
World hotel(const Spec& spec) {
  Plan plan;
  std::vector<Storey> storeys;
  for (int floor = 0; floor < kNumHotelFloors; ++floor) storeys.push_back(add_storey(plan, floor));
  std::vector<int> stairs;
  for (int floor = -1; floor < kNumHotelFloors; ++floor) stairs.push_back(add_stair(plan, floor));

  Draft draft = draft_of(spec, plan);
  for (int floor = 0; floor < kNumHotelFloors; ++floor) {
    furnish_storey(draft, storeys[static_cast<std::size_t>(floor)], floor);
  }
  for (const int unit : stairs) Dresser(draft, unit).dress_u_stair(kStairCorner_m, 0.0F);

  World world{.visits = {std::move(draft.building)}};
  Route& route = world.route;
  route.speed_m_s = 2.05;  // in a hurry: half of the way is stairs and turns, which slow down
  route.start_m = on_floor(kDown_m, -1.2, 0);
  route.start_heading_rad = -1.57079632679490;
  constexpr double kStretch_m = 1.2;
  constexpr double kTopStretch_m = 5.2;  // so that the second look comes late enough to count
  constexpr int kTop = kNumHotelFloors - 1;
  for (int floor = 0; floor < kTop; ++floor) {
    walk_out_and_back(route, floor, kStretch_m, 0.0);
    for (const auto& point : way_up(kStairCorner_m, 0.0F)) {
      walk(route, {point.cast<double>() + on_floor(0.0, 0.0, floor)});
    }
  }
  constexpr double kBack_m = 0.7;
  walk_out_and_back(route, kTop, kTopStretch_m, kBack_m);
  route.steps.emplace_back(Stand{1.0});
  walk(route, {on_floor(kDown_m, -kBack_m, kTop), on_floor(kDown_m, -kTopStretch_m, kTop)});
  return world;
}

}  // namespace samewhere::twin
