#include <algorithm>
#include <cmath>

#include <samewhere/core/errors.hpp>
#include <samewhere/twin/building/presets_dresser.hpp>

// How rooms end at the top: cornices, ducts and pipes along the walls, what hangs from ceilings.

namespace samewhere::twin {
namespace {

// Draws of the layout beside those of the gaps and bays.
constexpr std::uint64_t kCeilingDraws = 1ULL << 40;
constexpr std::uint64_t kEdgeDraws = 2ULL << 40;

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

// Things that look alike from below go together: lamps, vents, signs.
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

// Whether a wall of another space of the unit leaves here across this one, away from the observer.
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
  if (lamp_m.y() > 0.4F * course.width_m()) rows.assign(1, 0.5F);
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

}  // namespace samewhere::twin
