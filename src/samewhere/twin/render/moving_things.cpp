#include <algorithm>
#include <cmath>
#include <numbers>

#include <samewhere/twin/render/moving_things.hpp>

namespace samewhere::twin {
namespace {

constexpr float kShadowReach_m = 0.8F;
constexpr float kSmall_m = 0.25F;  // light hardly differs from end to end

struct Disc {
  Eigen::Vector3f middle = Eigen::Vector3f::Zero();
  Eigen::Vector3f normal = Eigen::Vector3f::UnitZ();
  float area_m2 = 0.0F;
};

// In pieces that are nearly square: a disc stands for no plank.
std::vector<Disc> discs_of(const Rectangle& r) {
  constexpr float kPiece_m = 0.2F;
  const Eigen::Array2f num_pieces = (r.size_m.array() / kPiece_m).ceil();
  const Eigen::Vector2f piece_m = r.size_m.array() / num_pieces;
  std::vector<Disc> discs;
  for (float v = 0.5F; v < num_pieces.y(); v += 1.0F) {
    for (float u = 0.5F; u < num_pieces.x(); u += 1.0F) {
      discs.push_back(
          {r.at(Eigen::Vector2f(u, v).cwiseProduct(piece_m)), r.normal(), piece_m.prod()});
    }
  }
  return discs;
}

// Share of what a point sees that a disc fills, roughly; none if it turns its back.
float share_filled(const Disc& disc, const SurfacePoint& point) {
  const Eigen::Vector3f to_disc = disc.middle - point.position;
  const float squared_m2 = to_disc.squaredNorm();
  if (squared_m2 > kShadowReach_m * kShadowReach_m) return 0.0F;
  const float here = point.normal.dot(to_disc);
  const float there = -disc.normal.dot(to_disc);
  if (here <= 0.0F || there <= 0.0F) return 0.0F;
  const float fade = 1.0F - squared_m2 / (kShadowReach_m * kShadowReach_m);
  return fade * disc.area_m2 * here * there /
         (squared_m2 * (std::numbers::pi_v<float> * squared_m2 + disc.area_m2));
}

bool is_small_flat(const Rectangle& r) {
  return r.turns_rad.isZero() && r.size_m.maxCoeff() < kSmall_m;
}

// Whether the right side of one is the left side of the next and both belong to something round.
bool share_side(const Rectangle& one, const Rectangle& next) {
  constexpr float kSame_m = 1e-4F;
  if (one.turns_rad.y() <= 0.0F || next.turns_rad.x() <= 0.0F) return false;
  const Eigen::Vector3f low_m = one.at({one.size_m.x(), 0.0F});
  const Eigen::Vector3f high_m = one.at(one.size_m);
  return (low_m - next.corner_m).norm() < kSame_m &&
         (high_m - next.at({0.0F, next.size_m.y()})).norm() < kSame_m;
}

}  // namespace

// Of surfaces one after another that are close together: a person.
struct MovingThings::Group {
  Eigen::Vector3f first_middle;
  std::vector<Disc> discs;
  Eigen::AlignedBox3f bounds;
};

MovingThings::MovingThings(const std::vector<Rectangle>& rectangles, const Light& light)
    : rectangles_(rectangles), light_(light), side_lights_(rectangles.size()) {
  constexpr float kGroup_m = 1.2F;
  if (rectangles.empty()) return;
  rays_.emplace(rectangles);
  for (const auto& r : rectangles) {
    const Eigen::Vector3f middle = r.at(0.5F * r.size_m);
    const bool is_new =
        groups_.empty() || (middle - groups_.back().first_middle).head<2>().norm() > kGroup_m;
    if (is_new) groups_.push_back({.first_middle = middle});
    for (const auto& disc : discs_of(r)) {
      groups_.back().discs.push_back(disc);
      groups_.back().bounds.extend(disc.middle);
    }
  }
}

MovingThings::~MovingThings() = default;

void MovingThings::meet(const Eigen::Vector3f& origin, std::span<const Eigen::Vector3f> directions,
                        int first_index, std::span<Hit> hits) const {
  if (!rays_) return;
  std::vector<Hit> mine(hits.size());
  rays_->first_hits(origin, directions, mine);
  for (std::size_t i = 0; i < hits.size(); ++i) {
    if (mine[i].rectangle < 0) continue;
    if (hits[i].rectangle >= 0 && hits[i].reach <= mine[i].reach) continue;
    hits[i] = {first_index + mine[i].rectangle, mine[i].reach};
  }
}

// At the left or right side, at a height from 0 to 1: on the round thing if it is a facet of one.
Colour MovingThings::light_at_side(const Rectangle& r, Side side, float up_ratio) const {
  constexpr float kOffSurface_m = 1e-3F;
  const bool is_right = side == Side::kRight;
  // of small flat pieces in the middle: their corners may be in something else
  const bool is_small = is_small_flat(r);
  const float right_ratio = is_small ? 0.5F : (is_right ? 1.0F : 0.0F);
  const Eigen::Vector3f on_it = r.at(r.size_m.cwiseProduct(Eigen::Vector2f(right_ratio, up_ratio)));
  const float turn_rad = is_right ? r.turns_rad.y() : -r.turns_rad.x();
  const Eigen::Vector3f normal = std::cos(turn_rad) * r.normal() + std::sin(turn_rad) * r.right;
  return light_.falling_on({on_it + kOffSurface_m * normal, normal});
}

MovingThings::SideLight MovingThings::light_along(const Rectangle& r, Side side) const {
  if (r.size_m.y() >= kSmall_m) {
    return {light_at_side(r, side, 0.0F), light_at_side(r, side, 1.0F)};
  }
  const Colour middle = light_at_side(r, side, 0.5F);
  return {middle, middle};
}

// Facets of a round thing come one after another: neighbours share the light on their common side.
const MovingThings::SideLight& MovingThings::side_light(int index, Side side) {
  const auto slot = [&](int of, Side which) -> std::optional<SideLight>& {
    return side_lights_[static_cast<std::size_t>(of)][static_cast<std::size_t>(which)];
  };
  auto& light = slot(index, side);
  if (light) return *light;
  const Rectangle& r = rectangle(index);
  const bool is_right = side == Side::kRight;
  const int next = index + (is_right ? 1 : -1);
  const Side opposite = is_right ? Side::kLeft : Side::kRight;
  if (next >= 0 && next < static_cast<int>(rectangles_.size()) &&
      share_side(is_right ? r : rectangle(next), is_right ? rectangle(next) : r)) {
    light = slot(next, opposite);
  }
  if (is_small_flat(r)) light = slot(index, opposite);
  if (!light) light = light_along(r, side);
  return *light;
}

Colour MovingThings::light_at(int index, const Eigen::Vector2f& right_up_m) {
  const Rectangle& r = rectangle(index);
  const SideLight& left = side_light(index, Side::kLeft);
  const SideLight& right = side_light(index, Side::kRight);
  const Eigen::Vector2f ratio = right_up_m.cwiseQuotient(r.size_m);
  const Colour lower = left[0] + ratio.x() * (right[0] - left[0]);
  const Colour upper = left[1] + ratio.x() * (right[1] - left[1]);
  return (lower + ratio.y() * (upper - lower)).max(0.0F);
}

float MovingThings::share_left(const SurfacePoint& point) const {
  constexpr float kStrength = 0.8F;  // light from far away comes from all sides
  float filled = 0.0F;
  for (const auto& group : groups_) {
    if (group.bounds.squaredExteriorDistance(point.position) > kShadowReach_m * kShadowReach_m) {
      continue;
    }
    for (const auto& disc : group.discs) filled += share_filled(disc, point);
  }
  return 1.0F - kStrength * std::min(filled, 1.0F);
}

}  // namespace samewhere::twin
