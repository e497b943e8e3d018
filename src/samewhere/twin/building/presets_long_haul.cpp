#include <algorithm>

#include <samewhere/twin/building/presets_dresser.hpp>
#include <samewhere/twin/building/presets_each.hpp>
#include <samewhere/twin/building/presets_route.hpp>

namespace samewhere::twin {
namespace {

constexpr int kNumLongHaulFloors = 3;
constexpr int kNumWings = 4;
constexpr float kPitch_m = 12.0F;  // from wing to wing
constexpr float kDepth_m = 14.0F;  // of the building, from wall to wall of its long corridors
constexpr float kWidth_m = 2.2F;   // of all corridors
constexpr float kLength_m = kNumWings * kPitch_m;
constexpr float kStairY_m = 5.6F;
// the middle of the foot of the flights up
constexpr double kFootY_m = kStairY_m + u_stair::kWidth_m - 0.5 * u_stair::kFlightWidth_m;

float height_m(int floor) { return u_stair::kStorey_m * static_cast<float>(floor); }

Space corridor(int floor, int unit, const Eigen::Vector2f& low_m, const Eigen::Vector2f& high_m) {
  return {.name = "corridor", .floor = floor, .unit = unit, .low_m = low_m, .high_m = high_m};
}

// A stretch of both long corridors, the cross corridor between them and an office.
struct Wing {
  int unit, south, cross, north, office;
  int first_number;
};

Wing add_wing(Plan& plan, int floor, int index) {
  const int unit =
      plan.add_unit(0, {.origin_m = {kPitch_m * static_cast<float>(index), 0.0F, height_m(floor)}});
  constexpr float kCrossX_m = 0.5F * (kPitch_m - kWidth_m);
  Wing wing{.unit = unit, .first_number = 100 * (floor + 1) + 20 * index + 1};
  wing.south = plan.add(corridor(floor, unit, {0.0F, 0.0F}, {kPitch_m, kWidth_m}));
  wing.cross = plan.add(
      corridor(floor, unit, {kCrossX_m, kWidth_m}, {kCrossX_m + kWidth_m, kDepth_m - kWidth_m}));
  wing.north = plan.add(corridor(floor, unit, {0.0F, kDepth_m - kWidth_m}, {kPitch_m, kDepth_m}));
  wing.office = plan.add({.name = "room " + std::to_string(wing.first_number + 19),
                          .floor = floor,
                          .unit = unit,
                          .low_m = {7.6F, kWidth_m + 0.15F},
                          .high_m = {11.4F, 6.0F},
                          .ground = FloorFinish::kWood});
  plan.add(doorway({.name = "doorway", .floor = floor, .unit = unit, .ground = FloorFinish::kWood},
                   {10.3F, kWidth_m + 0.075F}, false));
  return wing;
}

void furnish_wing(Draft& draft, const Wing& wing) {
  Dresser dresser(draft, wing.unit);
  dresser.number_from(wing.first_number);
  const auto plain = Use::kPlain;
  dresser.dress(wing.south, {.sides = {Use::kDoors, plain, plain, plain}});
  dresser.dress(wing.cross, {.sides = {plain, Use::kDoors, plain, plain}, .has_pipes = true});
  dresser.dress(wing.north, {.sides = {plain, plain, Use::kWindows, plain}});
  dresser.furnish_office(wing.office, 2);
}

// The corridor that joins the long ones at an end of the building, the stairs in its middle.
struct End {
  int unit = 0;
  int space = 0;
};

End add_end(Plan& plan, int floor, bool is_east) {
  const Eigen::Vector3f origin_m(is_east ? kLength_m : 0.0F, is_east ? kDepth_m : 0.0F,
                                 height_m(floor));
  const int unit = plan.add_unit(1, {.num_quarter_turns = is_east ? 2 : 0, .origin_m = origin_m});
  Space space = corridor(floor, unit, {-kWidth_m, 0.0F}, {0.0F, kDepth_m});
  space.name = "end";
  space.ground = FloorFinish::kTiles;
  return {unit, plan.add(space)};
}

void furnish_end(Draft& draft, const End& end, int floor) {
  Dresser dresser(draft, end.unit);
  const Wall beside = dresser.wall_of(end.space, 1);
  const Place number{beside, beside.from_m.y() < kStairY_m ? 5.3F : 0.3F};
  dresser.keep_free(number, 0.5F);
  dresser.dress(end.space, {.sides = {Use::kWindows, Use::kPlain, Use::kWindows, Use::kPlain}});
  dresser.furnisher().add_floor_number(number, floor);
}

int add_stair(Plan& plan, int floor, bool is_east) {
  const Eigen::Vector3f origin_m =
      is_east ? Eigen::Vector3f(kLength_m + kWidth_m, kDepth_m - kStairY_m, height_m(floor))
              : Eigen::Vector3f(-kWidth_m, kStairY_m, height_m(floor));
  const int unit = plan.add_unit(2, {.num_quarter_turns = is_east ? 3 : 1, .origin_m = origin_m});
  add_u_stair(plan, {.name = "stairs", .floor = floor, .unit = unit, .ground = FloorFinish::kTiles},
              Eigen::Vector2f::Zero());
  return unit;
}

// A corner, a junction or the foot of a stair.
struct Node {
  Eigen::Vector3d position_m;
  std::vector<int> neighbours;
};

// Nodes of a floor: along the south corridor, then along the north one, then the stairs west and
// east.
constexpr int kNumAlong = kNumWings + 2;
constexpr int kNumOnFloor = 2 * kNumAlong + 2;

double node_x_m(int along) {
  constexpr double kHalf_m = 0.5 * kWidth_m;
  if (along == 0) return -kHalf_m;
  if (along == kNumAlong - 1) return kLength_m + kHalf_m;
  return kPitch_m * (along - 0.5);
}

class Graph {
 public:
  Graph() : nodes_(static_cast<std::size_t>(kNumLongHaulFloors * kNumOnFloor)) {
    for (int floor = 0; floor < kNumLongHaulFloors; ++floor) add_floor(floor);
  }

  const Node& node(int index) const { return nodes_[static_cast<std::size_t>(index)]; }

 private:
  void add_floor(int floor) {
    const int first = floor * kNumOnFloor;
    const int stair = first + 2 * kNumAlong;
    const double z_m = height_m(floor);
    constexpr double kSouth_m = 0.5 * kWidth_m;
    constexpr double kNorth_m = kDepth_m - kSouth_m;
    for (int i = 0; i < kNumAlong; ++i) {
      const bool is_end = i == 0 || i == kNumAlong - 1;
      place(first + i, {node_x_m(i), kSouth_m, z_m});
      place(first + kNumAlong + i, {node_x_m(i), kNorth_m, z_m});
      if (!is_end) join(first + i, first + kNumAlong + i);
      if (i == 0) continue;
      join(first + i - 1, first + i);
      join(first + kNumAlong + i - 1, first + kNumAlong + i);
    }
    for (int side = 0; side < 2; ++side) {
      const int end = side * (kNumAlong - 1);
      place(stair + side, {node_x_m(end), side == 0 ? kFootY_m : kDepth_m - kFootY_m, z_m});
      join(stair + side, first + end);
      join(stair + side, first + kNumAlong + end);
      if (floor > 0) join(stair + side, stair + side - kNumOnFloor);
    }
  }

  void place(int node, const Eigen::Vector3d& position_m) {
    nodes_[static_cast<std::size_t>(node)].position_m = position_m;
  }
  void join(int a, int b) {
    nodes_[static_cast<std::size_t>(a)].neighbours.push_back(b);
    nodes_[static_cast<std::size_t>(b)].neighbours.push_back(a);
  }

  std::vector<Node> nodes_;
};

// The stairs of a floor up to the next, in the world.
std::vector<Eigen::Vector3d> way_up_from(int node) {
  const int floor = node / kNumOnFloor;
  const bool is_east = node % 2 == 1;
  std::vector<Eigen::Vector3d> way_m;
  for (const auto& p : way_up(Eigen::Vector2f::Zero(), height_m(floor))) {
    const Eigen::Vector3d on_west(-kWidth_m - p.y(), kStairY_m + p.x(), p.z());
    way_m.emplace_back(is_east ? kLength_m - on_west.x() : on_west.x(),
                       is_east ? kDepth_m - on_west.y() : on_west.y(), p.z());
  }
  // onto the corridor before the stair, where the flight ends
  const double x_m = node_x_m(is_east ? kNumAlong - 1 : 0);
  way_m.emplace_back(x_m, way_m.back().y(), way_m.back().z());
  return way_m;
}

void walk_edge(Route& route, const Graph& graph, int from, int to) {
  const double rise_m = graph.node(to).position_m.z() - graph.node(from).position_m.z();
  if (rise_m != 0.0) {
    auto way_m = way_up_from(rise_m > 0.0 ? from : to);
    if (rise_m < 0.0) std::reverse(way_m.begin(), way_m.end());
    walk(route, way_m);
  }
  walk(route, {graph.node(to).position_m});
}

Route random_walk(std::uint64_t seed, double duration_s) {
  const Graph graph;
  core::Random random(core::seed_of(seed, "twin.long_haul", 0));
  Route route;
  int before = -1;
  int here = 1;  // the junction of the first wing
  route.start_m = graph.node(here).position_m;
  for (double time_s = 0.0; time_s < duration_s;) {
    const auto& ways = graph.node(here).neighbours;
    // never straight back: everybody has somewhere to go
    int next = before;
    while (next == before) next = ways[random.index(ways.size())];
    walk_edge(route, graph, here, next);
    before = here;
    here = next;
    time_s = estimated_duration_s(route);
  }
  return route;
}

}  // namespace

// Three floors of four wings, 52 m x 14 m, and half an hour of wandering through them.
World long_haul(const Spec& spec) {
  Plan plan;
  std::vector<Wing> wings;
  std::vector<std::pair<End, int>> ends;
  std::vector<int> stairs;
  for (int floor = 0; floor < kNumLongHaulFloors; ++floor) {
    for (int i = 0; i < kNumWings; ++i) wings.push_back(add_wing(plan, floor, i));
    for (const bool is_east : {false, true})
      ends.emplace_back(add_end(plan, floor, is_east), floor);
  }
  // one more below, so that every floor has a flight down
  for (int floor = -1; floor < kNumLongHaulFloors; ++floor) {
    for (const bool is_east : {false, true}) stairs.push_back(add_stair(plan, floor, is_east));
  }
  Draft draft = draft_of(spec, plan);
  for (const Wing& wing : wings) furnish_wing(draft, wing);
  for (const auto& [end, floor] : ends) furnish_end(draft, end, floor);
  for (const int unit : stairs) {
    Dresser(draft, unit).dress_u_stair(Eigen::Vector2f::Zero(), 0.0F);
  }
  World world{.visits = {std::move(draft.building)}};
  constexpr double kHalfHour_s = 1800.0;
  world.route = random_walk(spec.seed, kHalfHour_s);
  return world;
}

}  // namespace samewhere::twin
