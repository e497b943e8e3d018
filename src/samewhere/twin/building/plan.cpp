#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/twin/building/plan.hpp>

namespace samewhere::twin {
namespace {

// Whole numbers of a sixth of a millimetre: a step of a stair is 1000, and quarter turns are exact.
using Ticks = std::int64_t;
constexpr double kTicks_per_m = 6000.0;

Ticks ticks(float metres) { return std::llround(kTicks_per_m * static_cast<double>(metres)); }
float metres(Ticks t) { return static_cast<float>(static_cast<double>(t) / kTicks_per_m); }

struct Range {
  Ticks low = 0;
  Ticks high = 0;

  bool is_empty() const { return low >= high; }
  bool operator==(const Range&) const = default;
};

Range common_part(const Range& a, const Range& b) {
  return {std::max(a.low, b.low), std::min(a.high, b.high)};
}

using Block = std::array<Range, 3>;

Block block_of(const Space& space) {
  return {{{ticks(space.low_m.x()), ticks(space.high_m.x())},
           {ticks(space.low_m.y()), ticks(space.high_m.y())},
           {ticks(space.floor_m), ticks(space.ceiling_m)}}};
}

Block turned(const Block& block, int num_quarter_turns) {
  Block b = block;
  const int num_turns = (num_quarter_turns % 4 + 4) % 4;
  for (int i = 0; i < num_turns; ++i) b = {{{-b[1].high, -b[1].low}, b[0], b[2]}};
  return b;
}

Block moved(Block block, const Eigen::Vector3f& by_m, int sign) {
  for (int axis = 0; axis < 3; ++axis) {
    const Ticks by = sign * ticks(by_m[axis]);
    auto& range = block[static_cast<std::size_t>(axis)];
    range = {range.low + by, range.high + by};
  }
  return block;
}

Block to_world(const Block& block, const Placement& placement) {
  return moved(turned(block, placement.num_quarter_turns), placement.origin_m, 1);
}

Block from_world(const Block& block, const Placement& placement) {
  return turned(moved(block, placement.origin_m, -1), -placement.num_quarter_turns);
}

bool is_overlapping(const Block& a, const Block& b) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (common_part(a[axis], b[axis]).is_empty()) return false;
  }
  return true;
}

// One side of a space as a rectangle of wall with openings.
struct Side {
  std::size_t axis = 0;  // that it stands across
  bool is_high = false;
  bool runs_backwards = false;  // left to right, seen from within
};
// clockwise, each from left to right as seen from within
constexpr std::array<Side, 4> kSides = {
    {{1, false, true}, {0, false, false}, {1, true, false}, {0, true, true}}};

Ticks plane_of(const Side& side, const Block& block) {
  return side.is_high ? block[side.axis].high : block[side.axis].low;
}

struct Opening {
  Range along;
  Range up;
};

std::vector<Opening> openings_of(const Side& side, const Block& own,
                                 const std::vector<Block>& others) {
  const std::size_t along = 1 - side.axis;
  const Ticks plane = plane_of(side, own);
  std::vector<Opening> openings;
  for (const auto& other : others) {
    const Ticks facing = side.is_high ? other[side.axis].low : other[side.axis].high;
    const Opening opening{common_part(own[along], other[along]), common_part(own[2], other[2])};
    if (facing != plane || opening.along.is_empty() || opening.up.is_empty()) continue;
    openings.push_back(opening);
  }
  std::sort(openings.begin(), openings.end(), [](const Opening& a, const Opening& b) {
    return std::pair(a.up.low, a.along.low) < std::pair(b.up.low, b.along.low);
  });
  return openings;
}

// What is left of `up` over a stretch that each opening covers wholly or not at all. The openings
// are sorted from low to high.
std::vector<Range> closed_parts(const Range& stretch, Range up,
                                const std::vector<Opening>& openings) {
  std::vector<Range> parts;
  for (const auto& opening : openings) {
    if (common_part(opening.along, stretch).is_empty()) continue;
    const Range below{up.low, opening.up.low};
    if (!below.is_empty()) parts.push_back(below);
    up.low = std::max(up.low, opening.up.high);
  }
  if (!up.is_empty()) parts.push_back(up);
  return parts;
}

// Pieces as openings the other way round, cut where the openings begin and end.
std::vector<Opening> closed_pieces(const Range& along, const Range& up,
                                   const std::vector<Opening>& openings) {
  std::vector<Ticks> cuts{along.low, along.high};
  for (const auto& opening : openings) {
    cuts.push_back(opening.along.low);
    cuts.push_back(opening.along.high);
  }
  std::sort(cuts.begin(), cuts.end());
  std::vector<Opening> pieces;
  for (std::size_t i = 1; i < cuts.size(); ++i) {
    const Range stretch{cuts[i - 1], cuts[i]};
    if (stretch.is_empty()) continue;
    for (const auto& part : closed_parts(stretch, up, openings)) {
      const auto before = std::find_if(pieces.begin(), pieces.end(), [&](const Opening& piece) {
        return piece.along.high == stretch.low && piece.up == part;
      });
      if (before != pieces.end()) {
        before->along.high = stretch.high;
      } else {
        pieces.push_back({stretch, part});
      }
    }
  }
  return pieces;
}

Eigen::Vector2f corner_on(const Side& side, Ticks plane, Ticks along) {
  return side.axis == 0 ? Eigen::Vector2f(metres(plane), metres(along))
                        : Eigen::Vector2f(metres(along), metres(plane));
}

WallPiece piece_on(const Side& side, const Block& block, const Opening& piece) {
  Range along = piece.along;
  if (side.runs_backwards) std::swap(along.low, along.high);
  const Ticks plane = plane_of(side, block);
  return {.side = static_cast<int>(&side - kSides.data()),
          .wall = {.from_m = corner_on(side, plane, along.low),
                   .to_m = corner_on(side, plane, along.high),
                   .floor_m = metres(block[2].low),
                   .ceiling_m = metres(block[2].high)},
          .low_m = metres(piece.up.low),
          .high_m = metres(piece.up.high)};
}

}  // namespace

int Plan::add_unit(int kind, const Placement& placement) {
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(
      0.5 * std::numbers::pi * placement.num_quarter_turns, Eigen::Vector3d::UnitZ()));
  units_.push_back({kind, {turn, placement.origin_m.cast<double>()}});
  placements_.push_back(placement);
  return static_cast<int>(units_.size()) - 1;
}

int Plan::add(const Space& space) {
  const Block block = to_world(block_of(space), placement_of(space));
  for (const auto& other : spaces_) {
    const bool overlaps = is_overlapping(block, to_world(block_of(other), placement_of(other)));
    core::require(!overlaps,
                  fmt::format("spaces \"{}\" and \"{}\" do not overlap", space.name, other.name));
  }
  spaces_.push_back(space);
  return static_cast<int>(spaces_.size()) - 1;
}

std::vector<WallPiece> Plan::walls_of(int space) const {
  const Space& own = this->space(space);
  const Block block = block_of(own);
  std::vector<Block> others;
  for (const auto& other : spaces_) {
    if (&other == &own) continue;
    others.push_back(from_world(to_world(block_of(other), placement_of(other)), placement_of(own)));
  }
  std::vector<WallPiece> walls;
  for (const Side& side : kSides) {
    auto pieces = closed_pieces(block[1 - side.axis], block[2], openings_of(side, block, others));
    if (side.runs_backwards) std::reverse(pieces.begin(), pieces.end());
    for (const auto& piece : pieces) walls.push_back(piece_on(side, block, piece));
  }
  return walls;
}

std::vector<Area> Plan::areas() const {
  std::vector<Area> areas;
  for (const auto& space : spaces_) {
    const Block block = to_world(block_of(space), placement_of(space));
    Area area{.name = space.name, .floor = space.floor, .unit = space.unit};
    for (int axis = 0; axis < 3; ++axis) {
      area.low_m[axis] = metres(block[static_cast<std::size_t>(axis)].low);
      area.high_m[axis] = metres(block[static_cast<std::size_t>(axis)].high);
    }
    areas.push_back(area);
  }
  return areas;
}

Space doorway(const Space& like, const Eigen::Vector2f& middle_m, bool is_along_x) {
  constexpr float kHalfWidth_m = 0.45F;
  constexpr float kHalfWall_m = 0.075F;
  constexpr float kHeight_m = 2.05F;
  const Eigen::Vector2f half_m = is_along_x ? Eigen::Vector2f(kHalfWall_m, kHalfWidth_m)
                                            : Eigen::Vector2f(kHalfWidth_m, kHalfWall_m);
  Space gap = like;
  gap.low_m = middle_m - half_m;
  gap.high_m = middle_m + half_m;
  gap.ceiling_m = like.floor_m + kHeight_m;
  gap.above = CeilingFinish::kPlaster;
  return gap;
}

namespace {

constexpr int kNumTreads = 8;
constexpr float kTread_m = 0.28F;
constexpr float kRise_m = u_stair::kStorey_m / 18.0F;
constexpr float kHeadroom_m = 2.7F;

float right_flight_m(const Eigen::Vector2f& corner_m) {
  return corner_m.x() + u_stair::kFlightWidth_m + u_stair::kCore_m;
}

}  // namespace

void add_u_stair(Plan& plan, const Space& like, const Eigen::Vector2f& corner_m) {
  const auto add = [&](const Eigen::Vector2f& low_m, const Eigen::Vector2f& size_m, int num_rises) {
    Space step = like;
    step.low_m = low_m;
    step.high_m = low_m + size_m;
    step.floor_m = like.floor_m + kRise_m * static_cast<float>(num_rises);
    step.ceiling_m = step.floor_m + kHeadroom_m;
    step.above = CeilingFinish::kPlaster;
    plan.add(step);
  };
  const Eigen::Vector2f tread_m(u_stair::kFlightWidth_m, kTread_m);
  for (int i = 0; i < kNumTreads; ++i) {
    const float y_m = corner_m.y() + kTread_m * static_cast<float>(i);
    add({right_flight_m(corner_m), y_m}, tread_m, i + 1);
    add({corner_m.x(), y_m}, tread_m, 2 * kNumTreads + 1 - i);
  }
  add(corner_m + Eigen::Vector2f(0.0F, u_stair::kFlight_m),
      {u_stair::kWidth_m, u_stair::kLanding_m}, kNumTreads + 1);
}

std::vector<Eigen::Vector3f> way_up(const Eigen::Vector2f& corner_m, float floor_m) {
  const float half_m = 0.5F * u_stair::kFlightWidth_m;
  const float left_m = corner_m.x() + half_m;
  const float right_m = right_flight_m(corner_m) + half_m;
  const float head_m = corner_m.y() + u_stair::kFlight_m;
  const float turn_m = head_m + half_m;
  const float half_up_m = floor_m + 0.5F * u_stair::kStorey_m;
  return {{right_m, corner_m.y(), floor_m}, {right_m, head_m, half_up_m},
          {right_m, turn_m, half_up_m},     {left_m, turn_m, half_up_m},
          {left_m, head_m, half_up_m},      {left_m, corner_m.y(), floor_m + u_stair::kStorey_m}};
}

}  // namespace samewhere::twin
