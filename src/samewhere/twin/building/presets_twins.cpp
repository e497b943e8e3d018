#include <samewhere/twin/building/presets_dresser.hpp>
#include <samewhere/twin/building/presets_each.hpp>
#include <samewhere/twin/building/presets_route.hpp>

namespace samewhere::twin {
namespace {

constexpr int kSouthWall = 0;

// A leg of 16 m, a connection from its east end to the other leg, a lounge and a store room.
struct Half {
  int unit, leg, connection, lounge, store;
};

Half add_half(Plan& plan, int num_quarter_turns) {
  const int unit = plan.add_unit(0, {.num_quarter_turns = num_quarter_turns});
  Half half{.unit = unit};
  half.leg = plan.add(
      {.name = "corridor", .unit = unit, .low_m = {-8.0F, -4.0F}, .high_m = {8.0F, -2.0F}});
  half.connection = plan.add(
      {.name = "connection", .unit = unit, .low_m = {6.0F, -2.0F}, .high_m = {8.0F, 2.0F}});
  half.lounge = plan.add({.name = "lounge",
                          .unit = unit,
                          .low_m = {-1.6F, -6.4F},
                          .high_m = {2.2F, -4.0F},
                          .ground = FloorFinish::kWood});
  half.store = plan.add({.name = "store",
                         .unit = unit,
                         .low_m = {-4.4F, -1.85F},
                         .high_m = {-0.2F, -0.1F},
                         .ground = FloorFinish::kTiles,
                         .above = CeilingFinish::kPlaster});
  plan.add(doorway({.name = "doorway", .unit = unit, .ground = FloorFinish::kTiles},
                   {-3.4F, -1.925F}, false));
  return half;
}

void furnish_half(Draft& draft, const Half& half, int first_number) {
  Dresser dresser(draft, half.unit);
  dresser.number_from(first_number);
  dresser.dress(half.leg, {.sides = {Use::kDoors, Use::kPlain, Use::kDoors, Use::kPlain}});
  dresser.dress(half.connection, {.sides = {Use::kPlain, Use::kPlain, Use::kPlain, Use::kWindows},
                                  .has_pipes = true});
  dresser.furnish_lounge(half.lounge, kSouthWall);
  dresser.dress(half.store,
                {.sides = {Use::kBare, Use::kPlain, Use::kBare, Use::kPlain}, .max_depth_m = 0.2F});
  const Wall back = dresser.wall_of(half.store, 2);
  for (const float along_m : {0.7F, 1.65F, 2.6F}) {
    dresser.furnisher().add_shelf(spot_before(back, along_m, 0.19F));
  }
  dresser.furnisher().add_bin(spot_before(back, 3.6F, 0.3F));
}

}  // namespace

// Two corridors 6 m apart, joined at both ends, the whole a half turn of itself.
World twin_corridors(const Spec& spec) {
  Plan plan;
  const Half first = add_half(plan, 0);
  const Half second = add_half(plan, 2);
  Draft draft = draft_of(spec, plan);
  furnish_half(draft, first, 101);
  furnish_half(draft, second, 151);

  World world{.visits = {std::move(draft.building)}};
  world.route.start_m = {-6.5, -3.0, 0.0};
  walk(world.route,
       {{7.0, -3.0, 0.0}, {7.0, 3.0, 0.0}, {-7.0, 3.0, 0.0}, {-7.0, -3.0, 0.0}, {1.0, -3.0, 0.0}});
  return world;
}

namespace {

// A wing to the west, and the west and south sides of the ring around the core.
struct Side {
  int unit, wing, lobby, hall;
};

Side add_side(Plan& plan, int num_quarter_turns) {
  const int unit = plan.add_unit(0, {.num_quarter_turns = num_quarter_turns});
  Side side{.unit = unit};
  side.wing =
      plan.add({.name = "wing", .unit = unit, .low_m = {-13.0F, -1.1F}, .high_m = {-4.7F, 1.1F}});
  side.lobby = plan.add({.name = "lobby",
                         .unit = unit,
                         .low_m = {-4.7F, -3.7F},
                         .high_m = {-2.5F, 3.7F},
                         .ground = FloorFinish::kTiles});
  side.hall = plan.add({.name = "lift hall",
                        .unit = unit,
                        .low_m = {-2.5F, -3.7F},
                        .high_m = {2.5F, -1.5F},
                        .ground = FloorFinish::kTiles});
  return side;
}

void furnish_side(Draft& draft, const Side& side, int first_number) {
  Dresser dresser(draft, side.unit);
  dresser.number_from(first_number);
  // the corners where a plant and a chair stand
  constexpr float kCorner_m = 0.9F;
  const Wall south = dresser.wall_of(side.wing, 0);
  dresser.keep_free({south, (south.to_m - south.from_m).norm() - 0.5F * kCorner_m}, kCorner_m);
  dresser.keep_free({dresser.wall_of(side.wing, 2), 0.5F * kCorner_m}, kCorner_m);
  const Wall end = dresser.wall_of(side.wing, 1);
  dresser.keep_free({end, 0.4F}, 0.8F);
  dresser.keep_free({end, 1.75F}, 0.8F);
  dresser.dress(side.wing, {.sides = {Use::kDoors, Use::kWindows, Use::kDoors, Use::kPlain}});
  dresser.dress(side.lobby, {.sides = {Use::kPlain, Use::kPlain, Use::kPlain, Use::kNothing}});
  dresser.dress(side.hall, {.sides = {Use::kWindows, Use::kPlain, Use::kNothing, Use::kPlain}});
  Furnisher& furnisher = dresser.furnisher();
  // beyond where one turns back
  furnisher.add_plant(spot_before(end, 0.4F, 0.45F));
  furnisher.add_chair(spot_before(end, 1.75F, 0.5F));
  // two lifts face the hall, the stairs and the toilets are behind doors towards the lobby
  const Wall lifts = dresser.wall_of(side.hall, 2);
  furnisher.add_lift_door({lifts, 1.4F}, 1);
  furnisher.add_floor_number({lifts, 2.5F}, 1);
  furnisher.add_lift_door({lifts, 3.6F}, 1);
  dresser.add_skirting(lifts, {{0.83F, 1.97F}, {3.03F, 4.17F}});
  const Wall core = dresser.wall_of(side.lobby, 3);
  furnisher.add_door({core, 0.62F}, first_number + 40);
  furnisher.add_sign({core, 1.53F}, Pictogram::kStairs);
  furnisher.add_door({core, 2.2F}, first_number + 41);
  dresser.add_skirting(core, {{0.1F, 1.14F}, {1.68F, 2.72F}});
}

}  // namespace

// Two wings left and right of a core of 5 m x 3 m with lifts and stairs, the whole a half turn of
// itself.
World mirror(const Spec& spec) {
  Plan plan;
  const Side west = add_side(plan, 0);
  const Side east = add_side(plan, 2);
  Draft draft = draft_of(spec, plan);
  furnish_side(draft, west, 101);
  furnish_side(draft, east, 201);

  World world{.visits = {std::move(draft.building)}};
  constexpr double kEnd_m = 9.6;
  constexpr double kLobby_m = 3.6;
  constexpr double kHall_m = 2.6;
  Route& route = world.route;
  route.start_m = {-kLobby_m, 0.0, 0.0};
  route.start_heading_rad = 3.14159265358979;
  walk(route, {{-kEnd_m, 0.0, 0.0}});
  turn(route, 0.0);
  walk(route, {{-kLobby_m, 0.0, 0.0},
               {-kLobby_m, kHall_m, 0.0},
               {kLobby_m, kHall_m, 0.0},
               {kLobby_m, 0.0, 0.0},
               {kEnd_m, 0.0, 0.0}});
  turn(route, 180.0);
  walk(route, {{kLobby_m, 0.0, 0.0},
               {kLobby_m, -kHall_m, 0.0},
               {-kLobby_m, -kHall_m, 0.0},
               {-kLobby_m, 0.0, 0.0},
               {-kEnd_m, 0.0, 0.0}});
  return world;
}

}  // namespace samewhere::twin
