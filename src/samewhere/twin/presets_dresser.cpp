#include <algorithm>
#include <cmath>

#include <samewhere/core/errors.hpp>
#include <samewhere/twin/presets_dresser.hpp>

namespace samewhere::twin {
namespace {

constexpr float kHalfDoor_m = 0.52F;  // with its frame
constexpr float kPlateEnd_m = 0.78F;  // right of the middle of a door
constexpr float kHalfWindow_m = 0.80F;
constexpr float kMargin_m = 0.06F;  // between one thing and the next

int kind_of(const Draft& draft, int unit) {
  return draft.plan.units()[static_cast<std::size_t>(unit)].kind;
}

// Colours are common to the whole building.
Style style_of(const Draft& draft, int unit) {
  const Spec& spec = draft.spec;
  return {.common_seed = core::seed_of(spec.seed, spec.preset, 0),
          .own_seed = core::seed_of(spec.seed, spec.preset, 1 + static_cast<std::uint64_t>(unit)),
          .similarity = spec.similarity,
          .visit = draft.visit.index};
}

// What hangs where is common to the units of one kind.
Style layout_of(const Draft& draft, int unit) {
  const Style style = style_of(draft, unit);
  const auto kind = static_cast<std::uint64_t>(kind_of(draft, unit));
  return {.common_seed = core::seed_of(style.common_seed, "twin.layout", kind),
          .own_seed = core::seed_of(style.own_seed, "twin.layout", 0),
          .similarity = style.similarity};
}

float length_of(const Wall& wall) { return (wall.to_m - wall.from_m).norm(); }

}  // namespace

Draft draft_of(const Spec& spec, const Plan& plan, const VisitSetting& visit) {
  return {spec, visit, plan, {.units = plan.units(), .areas = plan.areas()}};
}

Spot spot_before(const Wall& wall, float along_m, float out_m) {
  const Eigen::Vector2f right = (wall.to_m - wall.from_m).normalized();
  const Eigen::Vector2f out(right.y(), -right.x());
  const Eigen::Vector2f at = wall.from_m + along_m * right + out_m * out;
  return {{at.x(), at.y(), wall.floor_m}, std::atan2(out.y(), out.x())};
}

// Free wall between two things, and how far out it may be used.
struct Dresser::Gap {
  Wall wall;
  float from_m = 0.0F;
  float to_m = 0.0F;
  float max_depth_m = 0.0F;

  float width_m() const { return to_m - from_m; }
  float middle_m() const { return 0.5F * (from_m + to_m); }
};

namespace {

enum class Filling {
  kBoard,
  kPoster,
  kTwoPosters,
  kSwitch,
  kExtinguisher,
  kRadiator,
  kCabinet,
  kBin,
  kPlant,
  kChair,
  kCoatRack,
  kLeaflets,
  kLowShelf,
  kCrates
};

struct FillingSize {
  Filling filling;
  float width_m;
  float depth_m;
};

// The more often in the list, the more often on the wall.
constexpr std::array<FillingSize, 20> kFillings = {
    {{Filling::kBoard, 1.18F, 0.03F},        {Filling::kPoster, 0.64F, 0.03F},
     {Filling::kSwitch, 0.10F, 0.02F},       {Filling::kCabinet, 0.92F, 0.36F},
     {Filling::kExtinguisher, 0.22F, 0.19F}, {Filling::kTwoPosters, 1.40F, 0.03F},
     {Filling::kBoard, 1.18F, 0.03F},        {Filling::kPoster, 0.64F, 0.03F},
     {Filling::kRadiator, 1.20F, 0.13F},     {Filling::kBin, 0.40F, 0.40F},
     {Filling::kPlant, 0.60F, 0.60F},        {Filling::kChair, 0.60F, 0.60F},
     {Filling::kChair, 0.60F, 0.60F},        {Filling::kCoatRack, 1.00F, 0.25F},
     {Filling::kLeaflets, 0.74F, 0.05F},     {Filling::kLowShelf, 0.90F, 0.31F},
     {Filling::kCrates, 0.52F, 0.39F},       {Filling::kLeaflets, 0.74F, 0.05F},
     {Filling::kCoatRack, 1.00F, 0.25F},     {Filling::kLowShelf, 0.90F, 0.31F}}};

void add_filling(Furnisher& furnisher, Filling filling, const Place& place) {
  const auto spot = [&](float out_m) { return spot_before(place.wall, place.along_m, out_m); };
  switch (filling) {
    case Filling::kBoard:
      return furnisher.add_notice_board(place);
    case Filling::kPoster:
      return furnisher.add_framed_poster(place);
    case Filling::kTwoPosters:
      furnisher.add_framed_poster({place.wall, place.along_m - 0.37F});
      return furnisher.add_framed_poster({place.wall, place.along_m + 0.37F});
    case Filling::kSwitch:
      return furnisher.add_switch(place);
    case Filling::kExtinguisher:
      return furnisher.add_extinguisher(place);
    case Filling::kRadiator:
      return furnisher.add_radiator(place);
    case Filling::kCabinet:
      return furnisher.add_cabinet(place);
    case Filling::kBin:
      return furnisher.add_bin(spot(0.22F));
    case Filling::kPlant:
      return furnisher.add_plant(spot(0.30F));
    case Filling::kChair:
      return furnisher.add_chair(spot(0.32F));
    case Filling::kCoatRack:
      return furnisher.add_coat_rack(place);
    case Filling::kLeaflets:
      return furnisher.add_leaflets(place);
    case Filling::kLowShelf:
      return furnisher.add_low_shelf(place);
    case Filling::kCrates:
      return furnisher.add_crates(place);
  }
}

}  // namespace

Dresser::Dresser(Draft& draft, int unit)
    : plan_(draft.plan),
      unit_(unit),
      layout_(layout_of(draft, unit)),
      is_later_visit_(draft.visit.index > 0),
      furnisher_(draft.building, unit, style_of(draft, unit), draft.visit.light) {
  // things of other kinds of units draw for themselves
  constexpr int kMaxThings = 1000;
  for (int i = 0; i < kMaxThings * kind_of(draft, unit); ++i) furnisher_.skip_thing();
  add_surfaces();
}

void Dresser::add_surfaces() {
  for (int i = 0; i < static_cast<int>(plan_.spaces().size()); ++i) {
    const Space& space = plan_.space(i);
    if (space.unit != unit_) continue;
    furnisher_.add_floor(space.low_m, space.high_m, space.floor_m, space.ground);
    furnisher_.add_ceiling(space.low_m, space.high_m, space.ceiling_m, space.above);
    for (const auto& piece : plan_.walls_of(i)) {
      furnisher_.add_wall(piece.wall, piece.low_m, piece.high_m, space.walls);
    }
  }
}

void Dresser::dress(int space, const Dress& dress) {
  for (const auto& piece : plan_.walls_of(space)) {
    if (piece.is_whole()) dress_wall(piece, dress);
  }
  if (dress.has_lamps) add_ceiling_things(plan_.space(space));
}

void Dresser::dress_wall(const WallPiece& piece, const Dress& dress) {
  const Use use = dress.sides[static_cast<std::size_t>(piece.side)];
  if (use == Use::kNothing) return;
  Gap gap{.wall = piece.wall, .from_m = 0.0F, .max_depth_m = dress.max_depth_m};
  const bool has_bays = use == Use::kDoors || use == Use::kWindows;
  const auto doors_m =
      has_bays ? add_bays(use, dress.pitch_m, gap) : std::vector<Eigen::Vector2f>{};
  gap.to_m = piece.length_m();
  if (use != Use::kBare) fill_long_gap(gap);
  add_skirting(piece.wall, doors_m);
  constexpr float kShortest_m = 1.5F;
  if (piece.length_m() < kShortest_m) return;
  constexpr float kBelowCeiling_m = 0.34F;
  const float height_m = piece.wall.ceiling_m - piece.wall.floor_m - kBelowCeiling_m;
  if (use == Use::kDoors && dress.has_ducts) furnisher_.add_cable_duct(piece.wall);
  if (use == Use::kPlain && dress.has_pipes) furnisher_.add_pipes(piece.wall, height_m);
}

// As many doors or windows as there is room for, and what is between them. Leaves the gap behind
// the last; answers where the doors are.
std::vector<Eigen::Vector2f> Dresser::add_bays(Use use, float pitch_m, Gap& gap) {
  const float length_m = length_of(gap.wall);
  const bool has_doors = use == Use::kDoors;
  const int num_bays = static_cast<int>(length_m / pitch_m);
  std::vector<Eigen::Vector2f> doors_m;
  for (int i = 0; i < num_bays; ++i) {
    const float middle_m = (static_cast<float>(i) + 0.5F) * length_m / static_cast<float>(num_bays);
    add_bay({gap.wall, middle_m}, use);
    gap.to_m = middle_m - (has_doors ? kHalfDoor_m : kHalfWindow_m);
    fill_gap(gap);
    gap.from_m = middle_m + (has_doors ? kPlateEnd_m : kHalfWindow_m);
    if (has_doors) doors_m.emplace_back(middle_m - kHalfDoor_m, middle_m + kHalfDoor_m);
  }
  return doors_m;
}

// Piece by piece.
void Dresser::fill_long_gap(Gap gap) {
  constexpr float kPiece_m = 1.6F;
  const float to_m = gap.to_m;
  const float rest_m = to_m - gap.from_m;
  const int num_pieces = std::max(1, static_cast<int>(rest_m / kPiece_m));
  for (int i = 0; i < num_pieces; ++i) {
    gap.to_m = gap.from_m + rest_m / static_cast<float>(num_pieces);
    fill_gap(gap);
    gap.from_m = gap.to_m;
  }
}

void Dresser::add_bay(const Place& place, Use use) {
  if (use == Use::kDoors) {
    furnisher_.add_door(place, next_number_++);
  } else {
    furnisher_.add_window(place, Daylight::kBlinds);
  }
}

// Takes the same number of things whatever is chosen: look-alikes stay in step.
void Dresser::fill_gap(const Gap& gap) {
  Draws draws(layout_, num_gaps_++);
  std::vector<Filling> fitting;
  float widest_m = 0.0F;
  for (const auto& [filling, width_m, depth_m] : kFillings) {
    if (width_m + 2.0F * kMargin_m > gap.width_m() || depth_m > gap.max_depth_m) continue;
    fitting.push_back(filling);
    widest_m = std::max(widest_m, width_m);
  }
  if (fitting.empty()) return;
  const auto filling =
      fitting[static_cast<std::size_t>(draws.pick(static_cast<int>(fitting.size())))];
  const float slack_m = 0.5F * (gap.width_m() - widest_m) - kMargin_m;
  const Place place{gap.wall, gap.middle_m() + draws.shift(std::clamp(slack_m, 0.0F, 0.25F))};
  add_filling(furnisher_, filling, place);
  if (filling != Filling::kTwoPosters) furnisher_.skip_thing();
}

void Dresser::add_skirting(const Wall& wall, const std::vector<Eigen::Vector2f>& gaps_m) {
  float from_m = 0.0F;
  for (const auto& gap_m : gaps_m) {
    furnisher_.add_skirting(wall, from_m, gap_m.x());
    from_m = gap_m.y();
  }
  furnisher_.add_skirting(wall, from_m, length_of(wall));
}

void Dresser::add_ceiling_things(const Space& space) {
  constexpr float kPitch_m = 2.4F;
  const Eigen::Vector2f size_m = space.high_m - space.low_m;
  const int along = size_m.x() >= size_m.y() ? 0 : 1;
  const int num_rows = size_m[1 - along] > 3.2F ? 2 : 1;
  const int num_lamps = std::max(1, static_cast<int>(std::lround(size_m[along] / kPitch_m)));
  const auto at = [&](float ratio_along, float ratio_across) {
    Eigen::Vector2f point = space.low_m;
    point[along] += ratio_along * size_m[along];
    point[1 - along] += ratio_across * size_m[1 - along];
    return point;
  };
  const Eigen::Vector2f lamp_m =
      along == 0 ? Eigen::Vector2f(1.2F, 0.3F) : Eigen::Vector2f(0.3F, 1.2F);
  for (int row = 0; row < num_rows; ++row) {
    const float across = (static_cast<float>(row) + 0.5F) / static_cast<float>(num_rows);
    for (int i = 0; i < num_lamps; ++i) {
      const auto middle = (static_cast<float>(i) + 0.5F) / static_cast<float>(num_lamps);
      furnisher_.add_ceiling_lamp(at(middle, across), lamp_m, space.ceiling_m);
    }
  }
  for (int i = 1; i < num_lamps; ++i) {
    const auto between = static_cast<float>(i) / static_cast<float>(num_lamps);
    if (i % 2 == 1) {
      furnisher_.add_ceiling_vent(at(between, 0.5F), space.ceiling_m);
    } else {
      furnisher_.add_smoke_detector(at(between, 0.5F), space.ceiling_m);
    }
  }
  constexpr float kCorridor_m = 6.0F;
  if (size_m[along] < kCorridor_m) return;
  const float heading_rad = along == 0 ? 0.0F : 1.5707963F;
  furnisher_.add_exit_sign(at(1.3F / size_m[along], 0.5F), heading_rad, space.ceiling_m);
  furnisher_.add_exit_sign(at(1.0F - 1.3F / size_m[along], 0.5F), heading_rad, space.ceiling_m);
}

Wall Dresser::wall_of(int space, int side) const {
  WallPiece longest;
  longest.wall.to_m = longest.wall.from_m;
  for (const auto& piece : plan_.walls_of(space)) {
    const bool is_longer = piece.length_m() > longest.length_m();
    if (piece.side == side && piece.is_whole() && is_longer) longest = piece;
  }
  core::require(longest.length_m() > 0.0F, "the side of a space has a whole wall");
  return longest.wall;
}

void Dresser::furnish_office(int space, int window_side) {
  const auto far = static_cast<std::size_t>(window_side);
  Dress walls{.max_depth_m = 0.05F, .has_ducts = false};
  walls.sides[far] = Use::kWindows;
  walls.sides[(far + 1) % 4] = Use::kBare;
  dress(space, walls);
  const Wall window = wall_of(space, window_side);
  const Wall side = wall_of(space, (window_side + 1) % 4);
  const float middle_m = 0.5F * length_of(window);
  const float moved_m = is_later_visit_ ? 0.45F : 0.0F;
  furnisher_.add_desk(spot_before(window, middle_m, 1.35F));
  Spot chair = spot_before(window, middle_m - moved_m, 0.60F);
  chair.heading_rad += is_later_visit_ ? 0.8F : -0.2F;
  furnisher_.add_chair(chair);
  Spot visitor = spot_before(side, 0.5F * length_of(side) + moved_m, 0.9F);
  visitor.heading_rad += 0.5F - moved_m;
  furnisher_.add_chair(visitor);
  furnisher_.add_bin(spot_before(window, middle_m + (is_later_visit_ ? -1.1F : 1.1F), 1.2F));
  furnisher_.add_shelf(spot_before(side, length_of(side) - 0.6F, 0.19F));
  furnisher_.add_shelf(spot_before(side, 0.6F, 0.19F));
  if (is_later_visit_) return furnisher_.skip_thing();
  furnisher_.add_plant(spot_before(window, 0.4F, 0.4F));
}

void Dresser::furnish_lounge(int space, int sofa_side) {
  const auto far = static_cast<std::size_t>(sofa_side);
  Dress walls{.max_depth_m = 0.05F, .has_ducts = false};
  walls.sides = {Use::kWindows, Use::kWindows, Use::kWindows, Use::kWindows};
  walls.sides[far] = Use::kBare;
  walls.pitch_m = 2.2F;
  dress(space, walls);
  const Wall back = wall_of(space, sofa_side);
  const float middle_m = 0.5F * length_of(back);
  const float moved_m = is_later_visit_ ? 0.3F : 0.0F;
  furnisher_.add_framed_poster({back, middle_m - 0.5F});
  furnisher_.add_framed_poster({back, middle_m + 0.5F});
  furnisher_.add_sofa(spot_before(back, middle_m, 0.45F));
  furnisher_.add_table(spot_before(back, middle_m + moved_m, 1.35F));
  Spot chair = spot_before(back, middle_m + 1.1F + moved_m, 1.3F + 0.5F * moved_m);
  chair.heading_rad += is_later_visit_ ? -0.6F : -1.3F;
  furnisher_.add_chair(chair);
  furnisher_.add_bin(spot_before(back, is_later_visit_ ? length_of(back) - 0.3F : 0.95F, 0.25F));
  furnisher_.add_plant(spot_before(back, 0.4F, 0.45F));
}

void Dresser::dress_u_stair(const Eigen::Vector2f& corner_m, float floor_m) {
  using namespace u_stair;
  const float half_m = 0.5F * kStorey_m;
  const float head_m = corner_m.y() + kFlight_m;
  const float left_m = corner_m.x();
  const float right_m = corner_m.x() + kWidth_m;
  furnisher_.add_handrail(
      {{right_m, head_m}, {right_m, corner_m.y()}, floor_m + half_m, floor_m + half_m + 2.7F},
      -half_m);
  furnisher_.add_handrail(
      {{left_m, corner_m.y()}, {left_m, head_m}, floor_m + kStorey_m, floor_m + kStorey_m + 2.7F},
      -half_m);
  const Wall back{{left_m, head_m + kLanding_m},
                  {right_m, head_m + kLanding_m},
                  floor_m + half_m,
                  floor_m + half_m + 2.7F};
  furnisher_.add_window({back, 0.5F * kWidth_m}, Daylight::kBlinds);
  const float ends_m[2] = {head_m, head_m + kLanding_m};
  furnisher_.add_framed_poster(
      {{{right_m, ends_m[1]}, {right_m, ends_m[0]}, back.floor_m, back.ceiling_m}, 0.65F});
  furnisher_.add_notice_board(
      {{{left_m, ends_m[0]}, {left_m, ends_m[1]}, back.floor_m, back.ceiling_m}, 0.65F});
  furnisher_.add_ceiling_lamp({0.5F * (left_m + right_m), head_m + 0.5F * kLanding_m}, {1.2F, 0.3F},
                              back.ceiling_m);
  // on the ceiling of a step in the middle of each flight
  const float y_m = corner_m.y() + 0.5F * kFlight_m - 0.14F;
  const float rise_m = kStorey_m / 18.0F;
  furnisher_.add_ceiling_lamp({right_m - 0.5F * kFlightWidth_m, y_m}, {1.0F, 0.2F},
                              floor_m + 4.0F * rise_m + 2.7F);
  furnisher_.add_ceiling_lamp({left_m + 0.5F * kFlightWidth_m, y_m}, {1.0F, 0.2F},
                              floor_m + 14.0F * rise_m + 2.7F);
}

}  // namespace samewhere::twin
