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

// Draws of the layout beside those of the gaps, which count from 0.
constexpr std::uint64_t kCeilingDraws = 1ULL << 40;
constexpr std::uint64_t kEdgeDraws = 2ULL << 40;
constexpr std::uint64_t kBayDraws = 3ULL << 40;

constexpr int kNumLamps = 9;
const std::array<LampFitting, kNumLamps>& lamp_fittings() {
  static const std::array<LampFitting, kNumLamps> fittings = {
      {{LampFace::kRibbed, {1.2F, 0.3F}},
       {LampFace::kOpal, {0.6F, 0.6F}},
       {LampFace::kLouvre, {0.6F, 0.6F}},
       {LampFace::kTubes, {1.5F, 0.25F}},
       {LampFace::kRound, {0.36F, 0.36F}},
       {LampFace::kOpal, {1.4F, 0.08F}, 0.22F},
       {LampFace::kOpal, {1.2F, 0.15F}},
       {LampFace::kRound, {0.5F, 0.5F}},
       {LampFace::kLouvre, {1.2F, 0.2F}, 0.12F}}};
  return fittings;
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

// What is alike to whoever walks below goes together: lamps, vents, signs.
Dresser::CeilingDesign Dresser::ceiling_of(const Style& layout) {
  Draws draws(layout, kCeilingDraws);
  constexpr std::array<float, 4> kPitches_m = {2.4F, 1.8F, 3.2F, 4.0F};
  constexpr std::array<float, 3> kPhases = {0.5F, 0.25F, 0.75F};
  const std::array<std::vector<float>, 4> rows = {{{0.5F}, {0.28F}, {0.72F}, {0.26F, 0.74F}}};
  constexpr std::array<std::optional<VentKind>, 4> kVents = {VentKind::kGrille, VentKind::kSlot,
                                                             VentKind::kRound, std::nullopt};
  constexpr std::array<float, 3> kVentRows = {0.5F, 0.25F, 0.75F};
  constexpr std::array<float, 5> kSigns_m = {1.3F, 0.8F, 2.3F, 3.6F, 0.0F};
  CeilingDesign design;
  Choices lamps(draws.design());
  design.lamp = lamps.of(lamp_fittings());
  design.is_across = lamps.next(3) == 0;
  design.pitch_m = lamps.of(kPitches_m);
  design.phase = lamps.of(kPhases);
  design.rows = lamps.of(rows);
  Choices vents(draws.design());
  design.vent = vents.of(kVents);
  design.vent_row = vents.of(kVentRows);
  design.vent_step = 1 + vents.next(3);
  design.detector_row = vents.of(kVentRows);
  Choices signs(draws.design());
  design.signs_m = {signs.of(kSigns_m), signs.of(kSigns_m)};
  return design;
}

Dresser::EdgeDesign Dresser::edge_of(const Style& layout) {
  Draws draws(layout, kEdgeDraws);
  const std::array<Eigen::Vector2f, 4> cornices_m = {
      {{0.0F, 0.0F}, {0.06F, 0.06F}, {0.20F, 0.18F}, {0.12F, 0.05F}}};
  constexpr std::array<float, 4> kDucts_m = {0.22F, 0.0F, 0.36F, 0.28F};
  constexpr std::array<float, 3> kPipes_m = {0.42F, 0.55F, 0.48F};
  Choices choices(draws.design());
  return {.cornice_m = choices.of(cornices_m),
          .duct_below_m = choices.of(kDucts_m),
          .pipes_below_m = choices.of(kPipes_m)};
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

// Of whole walls and lintels in one plane, side by side.
std::vector<Dresser::TopEdge> Dresser::top_edges(int space, int side) const {
  const auto pieces = plan_.walls_of(space);
  const auto has_end = [&](const Eigen::Vector2f& at_m) {
    return std::any_of(pieces.begin(), pieces.end(), [&](const WallPiece& other) {
      return other.side != side && other.high_m == other.wall.ceiling_m &&
             (other.wall.from_m == at_m || other.wall.to_m == at_m);
    });
  };
  std::vector<TopEdge> edges;
  for (const auto& piece : pieces) {
    if (piece.side != side || piece.high_m != piece.wall.ceiling_m) continue;
    if (!edges.empty() && edges.back().wall.to_m == piece.wall.from_m) {
      edges.back().wall.to_m = piece.wall.to_m;
    } else {
      edges.push_back({.wall = piece.wall});
    }
  }
  for (auto& edge : edges) {
    edge.starts_in_corner = has_end(edge.wall.from_m);
    edge.ends_in_corner = has_end(edge.wall.to_m);
  }
  return edges;
}

// Whether a wall of another space of the unit leaves here across this one, away from who sees it.
bool Dresser::is_convex_corner(int space, const Eigen::Vector2f& at_m, const Wall& wall) const {
  const Eigen::Vector2f right = (wall.to_m - wall.from_m).normalized();
  const Eigen::Vector2f back(-right.y(), right.x());
  for (int i = 0; i < static_cast<int>(plan_.spaces().size()); ++i) {
    const Space& other = plan_.space(i);
    if (i == space || other.unit != unit_ || other.ceiling_m != wall.ceiling_m) continue;
    for (const auto& piece : plan_.walls_of(i)) {
      const Eigen::Vector2f along = (piece.wall.to_m - piece.wall.from_m).normalized();
      const Eigen::Vector2f& near_m = along.dot(back) > 0.0F ? piece.wall.from_m : piece.wall.to_m;
      if (near_m == at_m && std::abs(along.dot(back)) > 0.9F) return true;
    }
  }
  return false;
}

void Dresser::add_edges(int space, const Dress& dress) {
  for (int side = 0; side < 4; ++side) {
    const Use use = dress.sides[static_cast<std::size_t>(side)];
    for (const auto& edge : top_edges(space, side)) add_edge(space, edge, use, dress);
  }
}

// Cornices go around corners; ducts and pipes run from wall to wall or not at all. Takes three
// things whatever there is.
void Dresser::add_edge(int space, const TopEdge& edge, Use use, const Dress& dress) {
  const std::uint64_t end = furnisher_.num_things() + 3;
  const Eigen::Vector2f& cornice_m = edge_.cornice_m;
  if (dress.has_cornices && cornice_m.x() > 0.0F) {
    Wall wall = edge.wall;
    constexpr float kHair_m = 0.003F;  // behind the front of the cornice around the corner
    const Eigen::Vector2f beyond_m =
        (cornice_m.x() - kHair_m) * (wall.to_m - wall.from_m).normalized();
    const bool goes_on_left =
        !edge.starts_in_corner && is_convex_corner(space, edge.wall.from_m, edge.wall);
    const bool goes_on_right =
        !edge.ends_in_corner && is_convex_corner(space, edge.wall.to_m, edge.wall);
    if (goes_on_left) wall.from_m -= beyond_m;
    if (goes_on_right) wall.to_m += beyond_m;
    furnisher_.add_cornice(wall, cornice_m.x(), cornice_m.y());
  }
  const Wall& wall = edge.wall;
  const bool is_closed = edge.starts_in_corner && edge.ends_in_corner;
  if (is_closed && use == Use::kDoors && dress.has_ducts && edge_.duct_below_m > 0.0F) {
    furnisher_.add_cable_duct(wall, edge_.duct_below_m);
  }
  const float height_m = wall.ceiling_m - wall.floor_m - edge_.pipes_below_m;
  if (is_closed && use == Use::kPlain && dress.has_pipes) furnisher_.add_pipes(wall, height_m);
  while (furnisher_.num_things() < end) furnisher_.skip_thing();
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
  const float length_m = length_of(gap.wall);
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

// The widest part that nobody keeps free.
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
  furnisher_.add_skirting(wall, from_m, length_of(wall));
}

namespace {

// Along the longer side of a space and across it.
struct Course {
  explicit Course(const Space& space)
      : low_m(space.low_m),
        size_m(space.high_m - space.low_m),
        along(size_m.x() >= size_m.y() ? 0 : 1) {}

  float length_m() const { return size_m[along]; }
  float width_m() const { return size_m[1 - along]; }
  Eigen::Vector2f at(float along_m, float across_m) const {
    Eigen::Vector2f point = low_m;
    point[along] += along_m;
    point[1 - along] += across_m;
    return point;
  }

  Eigen::Vector2f low_m;
  Eigen::Vector2f size_m;
  int along;
};

// Where the middle of something of this size is, so that it stays off the walls.
float clear_of_ends(float wanted_m, float size_m, float room_m) {
  constexpr float kClear_m = 0.06F;
  const float least_m = 0.5F * size_m + kClear_m;
  return least_m > 0.5F * room_m ? 0.5F * room_m : std::clamp(wanted_m, least_m, room_m - least_m);
}

}  // namespace

// Takes the same number of things whatever the design: look-alikes stay in step.
void Dresser::add_ceiling_things(const Space& space) {
  constexpr float kPerMetre = 3.0F;
  constexpr std::uint64_t kAtLeast = 24;
  const std::uint64_t end = furnisher_.num_things() + kAtLeast +
                            static_cast<std::uint64_t>(kPerMetre * Course(space).length_m());
  const LampRow lamps = add_lamps(space);
  add_vents(space, lamps);
  add_exit_signs(space, lamps);
  core::require(furnisher_.num_things() <= end, "a ceiling has room for its things");
  while (furnisher_.num_things() < end) furnisher_.skip_thing();
}

Dresser::LampRow Dresser::add_lamps(const Space& space) {
  constexpr float kWide_m = 3.2F;
  const Course course(space);
  LampFitting lamp = ceiling_.lamp;
  if ((course.along == 0) == ceiling_.is_across) std::swap(lamp.size_m.x(), lamp.size_m.y());
  const Eigen::Vector2f lamp_m(lamp.size_m[course.along], lamp.size_m[1 - course.along]);
  std::vector<float> rows = ceiling_.rows;
  if (course.width_m() > kWide_m) rows = {0.25F, 0.75F};
  if (lamp_m.y() > 0.4F * course.width_m()) rows = {0.5F};
  // about as much light whatever the design
  const float usual_m2 =
      0.36F * ceiling_.pitch_m / 2.4F * (course.width_m() > kWide_m ? 2.0F : 1.0F);
  lamp.usual_m2 = usual_m2 / static_cast<float>(rows.size());
  const LampRow row_of_lamps = lamps_along(course.length_m(), lamp_m.x());
  for (const float row : rows) {
    const float across_m = clear_of_ends(row * course.width_m(), lamp_m.y(), course.width_m());
    for (int i = 0; i < row_of_lamps.num_lamps; ++i) {
      furnisher_.add_ceiling_lamp(course.at(row_of_lamps.middle_m(i), across_m), lamp,
                                  space.ceiling_m);
    }
  }
  return row_of_lamps;
}

// As near to the pitch as there is room for; what moves them leaves them clear of each other.
Dresser::LampRow Dresser::lamps_along(float room_m, float lamp_m) const {
  constexpr float kLeastGap_m = 0.15F;
  const auto most = static_cast<int>(room_m / (lamp_m + kLeastGap_m));
  const auto wanted = static_cast<int>(std::lround(room_m / ceiling_.pitch_m));
  LampRow row{.num_lamps = std::max(1, std::min(wanted, most))};
  row.step_m = room_m / static_cast<float>(row.num_lamps);
  row.gap_m = row.step_m - lamp_m;
  const float slack_m = std::max(0.0F, 0.5F * (row.gap_m - kLeastGap_m));
  row.shift_m = row.num_lamps == 1
                    ? 0.0F
                    : std::clamp((ceiling_.phase - 0.5F) * row.step_m, -slack_m, slack_m);
  return row;
}

// Between the lamps, where there is room, in turns with smoke detectors.
void Dresser::add_vents(const Space& space, const LampRow& lamps) {
  constexpr float kVent_m = 0.5F;
  const Course course(space);
  if (lamps.gap_m < kVent_m + 0.1F) return;
  for (int i = 1; i < lamps.num_lamps; ++i) {
    const float along_m = lamps.middle_m(i) - 0.5F * lamps.step_m;
    const auto at = [&](float row) {
      return course.at(along_m, clear_of_ends(row * course.width_m(), kVent_m, course.width_m()));
    };
    if (i % ceiling_.vent_step != 1 % ceiling_.vent_step) {
      furnisher_.add_smoke_detector(at(ceiling_.detector_row), space.ceiling_m);
    } else if (ceiling_.vent) {
      furnisher_.add_ceiling_vent(at(ceiling_.vent_row), *ceiling_.vent, space.ceiling_m);
    }
  }
}

// Not right below a lamp.
float Dresser::LampRow::beside_lamp_m(float wanted_m) const {
  constexpr float kBeside_m = 0.3F;
  const auto nearest = static_cast<int>(std::lround((wanted_m - shift_m) / step_m - 0.5F));
  const float lamp_m = middle_m(std::clamp(nearest, 0, num_lamps - 1));
  const float least_m = 0.5F * (step_m - gap_m) + kBeside_m;
  if (std::abs(wanted_m - lamp_m) >= least_m) return wanted_m;
  const float low_m = lamp_m - least_m;
  const float high_m = lamp_m + least_m;
  const float room_m = step_m * static_cast<float>(num_lamps);
  const bool has_room_above = high_m < room_m - kBeside_m;
  const bool is_below = (wanted_m < lamp_m && low_m > kBeside_m) || !has_room_above;
  return is_below ? low_m : high_m;
}

void Dresser::add_exit_signs(const Space& space, const LampRow& lamps) {
  constexpr float kCorridor_m = 6.0F;
  const Course course(space);
  if (course.length_m() < kCorridor_m) return;
  const float heading_rad = course.along == 0 ? 0.0F : 1.5707963F;
  const auto add_at = [&](float along_m) {
    furnisher_.add_exit_sign(course.at(lamps.beside_lamp_m(along_m), 0.5F * course.width_m()),
                             heading_rad, space.ceiling_m);
  };
  const auto [first_m, last_m] = ceiling_.signs_m;
  if (first_m > 0.0F) add_at(first_m);
  if (last_m > 0.0F) add_at(course.length_m() - last_m);
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
  furnisher_.add_bin(spot_before(back, is_later_visit_ ? length_of(back) - 0.3F : 0.86F, 0.25F));
  furnisher_.add_plant(spot_before(back, 0.4F, 0.7F));
}

void Dresser::hang_along_flights(const Eigen::Vector2f& corner_m, float floor_m) {
  using namespace u_stair;
  const float foot_m = corner_m.y();
  const float head_m = foot_m + kFlight_m;
  const float left_m = corner_m.x();
  const float right_m = corner_m.x() + kWidth_m;
  constexpr float kSlope = 0.5F * kStorey_m / kFlight_m;
  constexpr float kHigher_m = 0.12F;  // the handrail climbs below what hangs
  // as seen from the flight, which is so high at the wall's left end and climbs by so much a metre
  const auto hang = [&](const Eigen::Vector2f& from_m, const Eigen::Vector2f& to_m,
                        float left_end_m, float slope, bool is_framed) {
    for (const float along_m : {0.25F * kFlight_m, 0.68F * kFlight_m}) {
      const float step_m = left_end_m + slope * along_m + kHigher_m;
      const Place place{{from_m, to_m, step_m, step_m + 2.5F}, along_m};
      if (is_framed) {
        furnisher_.add_framed_poster(place);
      } else {
        furnisher_.add_notice(place);
      }
    }
  };
  const float half_up_m = floor_m + 0.5F * kStorey_m;
  hang({right_m, head_m}, {right_m, foot_m}, half_up_m, -kSlope, true);
  hang({left_m, foot_m}, {left_m, head_m}, floor_m + kStorey_m, -kSlope, true);
  const float inner_m[2] = {left_m + kFlightWidth_m, left_m + kFlightWidth_m + kCore_m};
  hang({inner_m[1], foot_m}, {inner_m[1], head_m}, floor_m, kSlope, false);
  hang({inner_m[0], head_m}, {inner_m[0], foot_m}, half_up_m, kSlope, false);
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
  furnisher_.add_radiator({back, 0.5F * kWidth_m});
  furnisher_.add_pipes(back, 2.3F);
  hang_along_flights(corner_m, floor_m);
  LampFitting lamp = ceiling_.lamp;
  lamp.drop_m = 0.0F;
  lamp.usual_m2 = 0.36F;
  furnisher_.add_ceiling_lamp({0.5F * (left_m + right_m), head_m + 0.5F * kLanding_m}, lamp,
                              back.ceiling_m);
  // on the ceiling of a step in the middle of each flight, and no longer than that
  const float y_m = corner_m.y() + 0.5F * kFlight_m - 0.14F;
  const float rise_m = kStorey_m / 18.0F;
  lamp.size_m.x() = std::min(lamp.size_m.x(), 1.0F);
  lamp.size_m.y() = std::min(lamp.size_m.y(), 0.2F);
  lamp.usual_m2 = 0.2F;
  furnisher_.add_ceiling_lamp({right_m - 0.5F * kFlightWidth_m, y_m}, lamp,
                              floor_m + 4.0F * rise_m + 2.7F);
  furnisher_.add_ceiling_lamp({left_m + 0.5F * kFlightWidth_m, y_m}, lamp,
                              floor_m + 14.0F * rise_m + 2.7F);
}

}  // namespace samewhere::twin
