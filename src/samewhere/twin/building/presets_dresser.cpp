#include <algorithm>
#include <cmath>

#include <samewhere/core/errors.hpp>
#include <samewhere/twin/building/presets_dresser.hpp>

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
  constexpr std::uint64_t kUnitsOfACopy = 1'000'000;
  const Spec& spec = draft.spec;
  const auto thing =
      static_cast<std::uint64_t>(spec.copy) * kUnitsOfACopy + 1 + static_cast<std::uint64_t>(unit);
  return {.common_seed = core::seed_of(spec.seed, spec.preset, 0),
          .own_seed = core::seed_of(spec.seed, spec.preset, thing),
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

// Draws of the layout beside those of the gaps, which count from 0.
constexpr std::uint64_t kBayDraws = 3ULL << 40;

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
  bool has_extinguishers = true;

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
  kCrates,
  kSign,
  kNotice
};

struct FillingSize {
  Filling filling;
  float width_m;
  float depth_m;
};

// The more often in the list, the more often on the wall.
constexpr std::array<FillingSize, 23> kFillings = {
    {{Filling::kBoard, 1.18F, 0.03F},        {Filling::kPoster, 0.64F, 0.03F},
     {Filling::kSwitch, 0.10F, 0.02F},       {Filling::kCabinet, 0.92F, 0.36F},
     {Filling::kExtinguisher, 0.22F, 0.19F}, {Filling::kTwoPosters, 1.40F, 0.03F},
     {Filling::kBoard, 1.18F, 0.03F},        {Filling::kPoster, 0.64F, 0.03F},
     {Filling::kRadiator, 1.36F, 0.13F},     {Filling::kBin, 0.40F, 0.40F},
     {Filling::kPlant, 0.60F, 0.60F},        {Filling::kChair, 0.60F, 0.60F},
     {Filling::kChair, 0.60F, 0.60F},        {Filling::kCoatRack, 1.00F, 0.25F},
     {Filling::kLeaflets, 0.74F, 0.05F},     {Filling::kLowShelf, 0.90F, 0.31F},
     {Filling::kCrates, 0.52F, 0.39F},       {Filling::kLeaflets, 0.74F, 0.05F},
     {Filling::kCoatRack, 1.00F, 0.25F},     {Filling::kLowShelf, 0.90F, 0.31F},
     {Filling::kSign, 0.22F, 0.02F},         {Filling::kNotice, 0.22F, 0.02F},
     {Filling::kNotice, 0.22F, 0.02F}}};

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
    case Filling::kSign:
      return furnisher.add_sign(place, Pictogram::kArrow);
    case Filling::kNotice:
      return furnisher.add_notice(place);
  }
}

}  // namespace

Dresser::Dresser(Draft& draft, int unit)
    : plan_(draft.plan),
      unit_(unit),
      layout_(layout_of(draft, unit)),
      ceiling_(ceiling_of(layout_)),
      edge_(edge_of(layout_)),
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
  add_edges(space, dress);
  if (dress.has_lamps) add_ceiling_things(plan_.space(space));
}

void Dresser::dress_wall(const WallPiece& piece, const Dress& dress) {
  const Use use = dress.sides[static_cast<std::size_t>(piece.side)];
  if (use == Use::kNothing) return;
  Gap gap{.wall = piece.wall,
          .from_m = 0.0F,
          .max_depth_m = dress.max_depth_m,
          .has_extinguishers = dress.has_extinguishers};
  const bool has_bays = use == Use::kDoors || use == Use::kWindows;
  const auto doors_m =
      has_bays ? add_bays(use, dress.pitch_m, gap) : std::vector<Eigen::Vector2f>{};
  gap.to_m = piece.length_m();
  if (use != Use::kBare) fill_long_gap(gap);
  add_skirting(piece.wall, doors_m);
}

// Doors between the first and the last need not stand in the middle of their bays.
float Dresser::shift_of_bay(bool is_door, int bay, int num_bays, float pitch_m) {
  constexpr float kMost_m = 0.35F;
  Draws draws(layout_, kBayDraws + num_bays_++);
  const float slack_m = 0.5F * (pitch_m - kHalfDoor_m - kPlateEnd_m);
  const float shift_m = draws.shift(std::clamp(slack_m, 0.0F, kMost_m));
  return is_door && bay > 0 && bay + 1 < num_bays ? shift_m : 0.0F;
}

// As many doors or windows as there is room for, and what is between them. Leaves the gap behind
// the last; answers where the doors are.
std::vector<Eigen::Vector2f> Dresser::add_bays(Use use, float pitch_m, Gap& gap) {
  const float length_m = gap.wall.length_m();
  const bool has_doors = use == Use::kDoors;
  const int num_bays = static_cast<int>(length_m / pitch_m);
  std::vector<Eigen::Vector2f> doors_m;
  for (int i = 0; i < num_bays; ++i) {
    const float shift_m = shift_of_bay(has_doors, i, num_bays, pitch_m);
    const float middle_m =
        (static_cast<float>(i) + 0.5F) * length_m / static_cast<float>(num_bays) + shift_m;
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

void Dresser::keep_free(const Place& middle, float width_m) {
  kept_.push_back({.wall = middle.wall,
                   .from_m = middle.along_m - 0.5F * width_m,
                   .to_m = middle.along_m + 0.5F * width_m});
}

// The widest part that is not kept free.
Dresser::Gap Dresser::without_kept(Gap gap) const {
  for (const Stretch& kept : kept_) {
    const bool is_same_wall = kept.wall.from_m == gap.wall.from_m &&
                              kept.wall.to_m == gap.wall.to_m &&
                              kept.wall.floor_m == gap.wall.floor_m;
    if (!is_same_wall || kept.to_m <= gap.from_m || kept.from_m >= gap.to_m) continue;
    if (kept.from_m - gap.from_m > gap.to_m - kept.to_m) {
      gap.to_m = kept.from_m;
    } else {
      gap.from_m = kept.to_m;
    }
  }
  return gap;
}

// Takes the same number of things whatever is chosen: look-alikes stay in step.
void Dresser::fill_gap(const Gap& whole_gap) {
  Draws draws(layout_, num_gaps_++);
  const Gap gap = without_kept(whole_gap);
  std::vector<Filling> fitting;
  float widest_m = 0.0F;
  for (const auto& [filling, width_m, depth_m] : kFillings) {
    if (width_m + 2.0F * kMargin_m > gap.width_m() || depth_m > gap.max_depth_m) continue;
    fitting.push_back(filling);
    widest_m = std::max(widest_m, width_m);
  }
  if (fitting.empty()) {
    for (int i = 0; i < 2; ++i) furnisher_.skip_thing();
    return;
  }
  auto filling = fitting[static_cast<std::size_t>(draws.pick(static_cast<int>(fitting.size())))];
  if (filling == Filling::kExtinguisher && !gap.has_extinguishers) filling = Filling::kSign;
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
  furnisher_.add_skirting(wall, from_m, wall.length_m());
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

}  // namespace samewhere::twin
