#include <samewhere/twin/building/presets_dresser.hpp>
#include <samewhere/twin/building/presets_each.hpp>
#include <samewhere/twin/building/presets_route.hpp>

namespace samewhere::twin {
namespace {

constexpr int kNumAisles = 4;
constexpr float kHeight_m = 6.0F;
constexpr float kAislePitch_m = 4.8F;  // from aisle to aisle: two racks and the way between them
constexpr float kRackLength_m = 6.3F;
constexpr float kCross_m = 3.4F;   // width of the cross aisles
constexpr float kMargin_m = 0.8F;  // beside the outer racks
constexpr float kRackDepth_m = 1.1F;
constexpr float kBehind_m = 0.12F;  // between the backs of two racks, half of it
constexpr float kHallWidth_m = kNumAisles * kAislePitch_m;

Space hall(int unit, const std::string& name, const Eigen::Vector2f& low_m,
           const Eigen::Vector2f& high_m) {
  return {.name = name,
          .unit = unit,
          .low_m = low_m,
          .high_m = high_m,
          .ceiling_m = kHeight_m,
          .walls = WallFinish::kBlocks,
          .ground = FloorFinish::kConcrete,
          .above = CeilingFinish::kConcrete};
}

// Every other aisle is turned by half a turn: a serpentine sees all of them from the same end.
int add_aisle(Plan& plan, int index) {
  const bool is_turned = index % 2 == 1;
  const float x_m = kAislePitch_m * static_cast<float>(is_turned ? index + 1 : index);
  const int unit = plan.add_unit(0, {.num_quarter_turns = is_turned ? 2 : 0,
                                     .origin_m = {x_m, is_turned ? kRackLength_m : 0.0F, 0.0F}});
  plan.add(hall(unit, "aisle " + std::to_string(index + 1), {0.0F, 0.0F},
                {kAislePitch_m, kRackLength_m}));
  return unit;
}

void furnish_aisle(Draft& draft, int unit) {
  Dresser dresser(draft, unit);
  Furnisher& furnisher = dresser.furnisher();
  const RackSize size{.length_m = 6.0F, .num_levels = 4};
  const float middle_m = 0.5F * kRackLength_m;
  furnisher.add_rack({{kBehind_m + 0.5F * kRackDepth_m, middle_m, 0.0F}, 0.0F}, size);
  furnisher.add_rack(
      {{kAislePitch_m - kBehind_m - 0.5F * kRackDepth_m, middle_m, 0.0F}, 3.14159265F}, size);
  for (const float along : {0.15F, 0.5F, 0.85F}) {
    furnisher.add_high_bay_lamp({0.5F * kAislePitch_m, along * kRackLength_m}, kHeight_m);
  }
}

// A cross aisle before the racks and the margin beside the first.
struct Cross {
  int unit, way, margin;
};

Cross add_cross(Plan& plan, bool is_turned) {
  Cross cross{.unit = plan.add_unit(
                  1, {.num_quarter_turns = is_turned ? 2 : 0,
                      .origin_m = is_turned ? Eigen::Vector3f(kHallWidth_m, kRackLength_m, 0.0F)
                                            : Eigen::Vector3f(0.0F, 0.0F, 0.0F)})};
  cross.way = plan.add(
      hall(cross.unit, "cross aisle", {-kMargin_m, -kCross_m}, {kHallWidth_m + kMargin_m, 0.0F}));
  cross.margin =
      plan.add(hall(cross.unit, "cross aisle", {-kMargin_m, 0.0F}, {0.0F, kRackLength_m}));
  return cross;
}

void furnish_cross(Draft& draft, const Cross& cross, int first_number) {
  Dresser dresser(draft, cross.unit);
  Furnisher& furnisher = dresser.furnisher();
  const Wall back = dresser.wall_of(cross.way, 0);
  furnisher.add_double_door({back, 2.4F});
  furnisher.add_door({back, 5.2F}, first_number);
  furnisher.add_extinguisher({back, 6.3F});
  furnisher.add_notice_board({back, 7.4F});
  for (const float along_m : {8.9F, 10.3F}) furnisher.add_pallet(spot_before(back, along_m, 0.5F));
  furnisher.add_sign({back, 11.6F}, Pictogram::kArrow);
  furnisher.add_door({back, 13.0F}, first_number + 1);
  furnisher.add_window({back, 15.0F}, Daylight::kBlinds);
  furnisher.add_bin(spot_before(back, 16.4F, 0.3F));
  furnisher.add_pallet(spot_before(back, 18.0F, 0.5F));
  furnisher.add_pipes(back, 3.2F);
  const Wall left = dresser.wall_of(cross.way, 1);
  furnisher.add_framed_poster({left, 1.2F});
  furnisher.add_switch({left, 2.2F});
  furnisher.add_pipes(left, 3.2F);
  furnisher.add_sign({dresser.wall_of(cross.way, 3), 1.4F}, Pictogram::kArrow);
  for (int i = 0; i < kNumAisles; ++i) {
    const float x_m = kAislePitch_m * (static_cast<float>(i) + 0.5F);
    furnisher.add_high_bay_lamp({x_m, -0.5F * kCross_m}, kHeight_m);
    furnisher.add_bay_number({back, kHallWidth_m + kMargin_m - x_m}, first_number + i);
  }
}

}  // namespace

// A hall of 20 m x 13.7 m, 6 m high, with four aisles between racks; a robot drives all of them.
World warehouse(const Spec& spec) {
  Plan plan;
  std::vector<int> aisles;
  for (int i = 0; i < kNumAisles; ++i) aisles.push_back(add_aisle(plan, i));
  const Cross south = add_cross(plan, false);
  const Cross north = add_cross(plan, true);
  Draft draft = draft_of(spec, plan);
  for (const int unit : aisles) furnish_aisle(draft, unit);
  furnish_cross(draft, south, 1);
  furnish_cross(draft, north, 11);

  World world{.visits = {std::move(draft.building)}};
  Route& route = world.route;
  route = {.carrier = Carrier::kRobot, .speed_m_s = 1.75, .camera_height_m = 0.75};
  constexpr double kSouth_m = -1.25;
  constexpr double kNorth_m = kRackLength_m + 1.25;
  const auto aisle_x_m = [](int i) { return static_cast<double>(kAislePitch_m) * (i + 0.5); };
  route.start_m = {aisle_x_m(0), kSouth_m, 0.0};
  route.start_heading_rad = 1.57079632679490;
  for (int i = 0; i < kNumAisles; ++i) {
    const bool goes_north = i % 2 == 0;
    walk(route, {{aisle_x_m(i), goes_north ? kNorth_m : kSouth_m, 0.0}});
    const bool is_last = i + 1 == kNumAisles;
    walk(route, {{aisle_x_m(is_last ? 0 : i + 1), goes_north ? kNorth_m : kSouth_m, 0.0}});
  }
  walk(route, {{aisle_x_m(0), 0.55 * kRackLength_m, 0.0}});
  return world;
}

}  // namespace samewhere::twin
