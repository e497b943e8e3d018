#include <samewhere/twin/building/presets_dresser.hpp>
#include <samewhere/twin/building/presets_each.hpp>
#include <samewhere/twin/building/presets_route.hpp>

namespace samewhere::twin {
namespace {

// A corridor around a block: the inner sides of its outer walls, and how wide it is.
struct Ring {
  Eigen::Vector2f half_m;
  float width_m;
};

struct RingSpaces {
  int south, east, north, west;
};

RingSpaces add_ring(Plan& plan, int unit, const Ring& ring) {
  const Eigen::Vector2f outer = ring.half_m;
  const Eigen::Vector2f inner = ring.half_m - Eigen::Vector2f::Constant(ring.width_m);
  const auto add = [&](const Eigen::Vector2f& low_m, const Eigen::Vector2f& high_m) {
    return plan.add({.name = "corridor", .unit = unit, .low_m = low_m, .high_m = high_m});
  };
  return {.south = add(-outer, {outer.x(), -inner.y()}),
          .east = add({inner.x(), -inner.y()}, {outer.x(), inner.y()}),
          .north = add({-outer.x(), inner.y()}, outer),
          .west = add({-outer.x(), -inner.y()}, {-inner.x(), inner.y()})};
}

int add_room(Plan& plan, const std::string& name, const Eigen::Vector2f& low_m,
             const Eigen::Vector2f& high_m) {
  return plan.add({.name = name,
                   .low_m = low_m,
                   .high_m = high_m,
                   .ground = FloorFinish::kWood,
                   .above = CeilingFinish::kPlaster});
}

void add_doorway(Plan& plan, const Eigen::Vector2f& middle_m, bool is_along_x) {
  plan.add(doorway({.name = "doorway", .ground = FloorFinish::kWood}, middle_m, is_along_x));
}

// Walks around a ring counter-clockwise from its lower side to (end_x_m, lower side).
void walk_around(Route& route, const Eigen::Vector2d& half_m, double end_x_m) {
  const double x = half_m.x();
  const double y = half_m.y();
  walk(route, {{x, -y, 0.0}, {x, y, 0.0}, {-x, y, 0.0}, {-x, -y, 0.0}, {end_x_m, -y, 0.0}});
}

constexpr int kSouth = 0;
constexpr int kWest = 1;
constexpr int kNorth = 2;
constexpr int kEast = 3;

}  // namespace

// A corridor 2 m wide around a block of 12 m x 6 m, two offices open inside it, two outside, with
// windows at the short ends.
World office_loop(const Spec& spec) {
  Plan plan;
  const int unit = plan.add_unit(0, {});
  const RingSpaces ring = add_ring(plan, unit, {{8.0F, 5.0F}, 2.0F});
  const int inner_south = add_room(plan, "room 391", {-5.0F, -2.85F}, {-1.2F, 0.6F});
  add_doorway(plan, {-4.0F, -2.925F}, false);
  const int inner_north = add_room(plan, "room 392", {1.2F, -0.6F}, {5.0F, 2.85F});
  add_doorway(plan, {3.9F, 2.925F}, false);
  const int outer_south = add_room(plan, "room 393", {1.6F, -8.8F}, {5.6F, -5.15F});
  add_doorway(plan, {2.5F, -5.075F}, false);
  const int outer_north = plan.add({.name = "lounge",
                                    .low_m = {-4.5F, 5.0F},
                                    .high_m = {-0.5F, 7.4F},
                                    .ground = FloorFinish::kWood});

  Draft draft = draft_of(spec, plan);
  Dresser dresser(draft, unit);
  dresser.number_from(301);
  const auto doors = Use::kDoors;
  dresser.dress(ring.south, {.sides = {doors, Use::kPlain, doors, Use::kPlain}});
  dresser.dress(ring.east, {.sides = {Use::kPlain, doors, Use::kPlain, Use::kWindows}});
  dresser.dress(ring.north, {.sides = {doors, Use::kPlain, doors, Use::kPlain}});
  dresser.dress(ring.west, {.sides = {Use::kPlain, Use::kWindows, Use::kPlain, doors}});
  dresser.furnish_office(inner_south, kNorth);
  dresser.furnish_office(inner_north, kSouth);
  dresser.furnish_office(outer_south, kSouth);
  dresser.furnish_lounge(outer_north, kNorth);

  World world{.visits = {std::move(draft.building)}};
  world.route.look_aside_rad = 0.5;  // a person that films both sides
  world.route.start_m = {-3.5, -4.0, 0.0};
  walk_around(world.route, {7.0, 4.0}, -3.5);
  walk(world.route, {{6.5, -4.0, 0.0}});
  return world;
}

namespace {

struct Ward {
  RingSpaces ring;
  int office, staff_room, lounge;
};

Ward add_ward(Plan& plan) {
  const int unit = plan.add_unit(0, {});
  Ward ward{.ring = add_ring(plan, unit, {{5.6F, 4.1F}, 2.2F})};
  ward.staff_room = add_room(plan, "room 191", {-3.25F, -1.75F}, {0.6F, 1.75F});
  add_doorway(plan, {-2.4F, -1.825F}, false);
  ward.office = add_room(plan, "room 192", {5.75F, -3.2F}, {9.2F, 0.8F});
  add_doorway(plan, {5.675F, -0.1F}, true);
  ward.lounge = plan.add({.name = "lounge",
                          .low_m = {-2.2F, 4.1F},
                          .high_m = {2.0F, 6.5F},
                          .ground = FloorFinish::kWood});
  return ward;
}

Building furnish_ward(const Spec& spec, const Plan& plan, const Ward& ward,
                      const VisitSetting& visit) {
  Draft draft = draft_of(spec, plan, visit);
  Dresser dresser(draft, 0);
  dresser.number_from(101);
  const auto doors = Use::kDoors;
  const auto windows = Use::kWindows;
  dresser.dress(ward.ring.south, {.sides = {windows, Use::kPlain, doors, Use::kPlain}});
  dresser.dress(ward.ring.east, {.sides = {Use::kPlain, doors, Use::kPlain, windows}});
  dresser.dress(ward.ring.north, {.sides = {doors, Use::kPlain, windows, Use::kPlain}});
  dresser.dress(ward.ring.west, {.sides = {Use::kPlain, windows, Use::kPlain, doors}});
  dresser.furnish_office(ward.staff_room, kNorth);
  dresser.furnish_office(ward.office, kEast);
  dresser.furnish_lounge(ward.lounge, kNorth);
  return std::move(draft.building);
}

}  // namespace

// A corridor around a block of 6.8 m x 3.8 m with windows on all sides, by lamplight and by day.
World second_visit(const Spec& spec) {
  Plan plan;
  const Ward ward = add_ward(plan);
  constexpr LightSetting kEvening{.lamps = 1.0F, .daylight = 0.1F};
  constexpr LightSetting kDay{.lamps = 0.0F, .daylight = 1.2F};
  const bool begins_by_day = core::Random(core::seed_of(spec.seed, "twin.visit", 0)).index(2) == 1;
  World world;
  world.visits = {
      furnish_ward(spec, plan, ward, {.index = 0, .light = begins_by_day ? kDay : kEvening}),
      furnish_ward(spec, plan, ward, {.index = 1, .light = begins_by_day ? kEvening : kDay})};
  world.route.start_m = {-1.0, -3.0, 0.0};
  walk_around(world.route, {4.5, 3.0}, -1.0);
  world.route.steps.emplace_back(Darken{2.0});
  walk_around(world.route, {4.5, 3.0}, -1.0);
  return world;
}

}  // namespace samewhere::twin
