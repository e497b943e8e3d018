#include <samewhere/twin/building/presets_dresser.hpp>
#include <samewhere/twin/building/presets_each.hpp>
#include <samewhere/twin/building/presets_route.hpp>

namespace samewhere::twin {
namespace {

// A bay ends with a portal, a little narrower and lower than the corridor: there one unit may end
// and the next begin without a seam that shows.
constexpr float kBay_m = 2.4F;
constexpr float kPortal_m = 0.15F;
constexpr float kHalfWidth_m = 1.0F;
constexpr float kBend_m = 2.0F;    // along the legs
constexpr float kOffset_m = 5.0F;  // from leg to leg

struct Part {
  int unit = 0;
  int space = 0;
};

void add_portal(Plan& plan, int unit, const Eigen::Vector2f& entry_m) {
  constexpr float kPier_m = 0.1F;
  plan.add({.name = "corridor",
            .unit = unit,
            .low_m = {entry_m.x(), entry_m.y() - kHalfWidth_m + kPier_m},
            .high_m = {entry_m.x() + kPortal_m, entry_m.y() + kHalfWidth_m - kPier_m},
            .ceiling_m = 2.36F,
            .above = CeilingFinish::kPlaster});
}

// A piece of corridor from the origin on, `length_m` with its portal.
Part add_straight(Plan& plan, int kind, const Eigen::Vector3f& origin_m, float length_m) {
  const int unit = plan.add_unit(kind, {.origin_m = origin_m});
  add_portal(plan, unit, {length_m - kPortal_m, 0.0F});
  return {unit, plan.add({.name = "corridor",
                          .unit = unit,
                          .low_m = {0.0F, -kHalfWidth_m},
                          .high_m = {length_m - kPortal_m, kHalfWidth_m}})};
}

// To the right and on to the left.
Part add_bend(Plan& plan, const Eigen::Vector3f& origin_m) {
  const int unit = plan.add_unit(1, {.origin_m = origin_m});
  add_portal(plan, unit, {kBend_m, -kOffset_m});
  return {unit, plan.add({.name = "bend",
                          .unit = unit,
                          .low_m = {0.0F, -kOffset_m - kHalfWidth_m},
                          .high_m = {kBend_m, kHalfWidth_m},
                          .ground = FloorFinish::kTiles})};
}

struct Walkway {
  std::vector<Part> bays;
  std::vector<Part> bends;
  std::vector<Part> ends;
  std::vector<Eigen::Vector3d> points_m;
};

Walkway add_walkway(Plan& plan) {
  Walkway way;
  Eigen::Vector3f at_m(0.0F, 0.0F, 0.0F);
  constexpr float kEnd_m = 2.0F;
  way.ends.push_back(add_straight(plan, 2, at_m, kEnd_m));
  way.points_m.emplace_back(0.7, 0.0, 0.0);
  at_m.x() += kEnd_m;
  for (const int num_bays : {7, 7, 6}) {
    for (int i = 0; i < num_bays; ++i) {
      way.bays.push_back(add_straight(plan, 0, at_m, kBay_m));
      at_m.x() += kBay_m;
    }
    if (way.bends.size() == 2) break;
    way.bends.push_back(add_bend(plan, at_m));
    at_m.x() += 0.5F * kBend_m;
    way.points_m.push_back(at_m.cast<double>());
    at_m.y() -= kOffset_m;
    way.points_m.push_back(at_m.cast<double>());
    at_m.x() += 0.5F * kBend_m + kPortal_m;
  }
  way.ends.push_back(add_straight(plan, 3, at_m, kEnd_m));
  way.points_m.emplace_back(at_m.x() + 0.8, at_m.y(), 0.0);
  return way;
}

}  // namespace

// Twenty bays with a door on either side, in three legs out of each other's sight.
World no_return(const Spec& spec) {
  Plan plan;
  const Walkway way = add_walkway(plan);
  Draft draft = draft_of(spec, plan);
  int number = 101;
  for (const Part& bay : way.bays) {
    Dresser dresser(draft, bay.unit);
    dresser.number_from(number);
    dresser.dress(bay.space, {.sides = {Use::kDoors, Use::kBare, Use::kDoors, Use::kBare},
                              .pitch_m = kBay_m - kPortal_m,
                              .has_cornices = false,  // portals end them
                              .has_extinguishers = false});
    number += 2;
  }
  for (const Part& bend : way.bends) {
    Dresser(draft, bend.unit).dress(bend.space, {.has_pipes = true});
  }
  for (const Part& end : way.ends) Dresser(draft, end.unit).dress(end.space, {.max_depth_m = 0.1F});

  World world{.visits = {std::move(draft.building)}};
  world.route.start_m = way.points_m.front();
  walk(world.route, {way.points_m.begin() + 1, way.points_m.end()});
  return world;
}

}  // namespace samewhere::twin
