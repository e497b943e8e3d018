#include <algorithm>
#include <cmath>
#include <numbers>

#include <samewhere/twin/moving_things.hpp>

namespace samewhere::twin {
namespace {

constexpr float kShadowReach_m = 0.8F;

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

}  // namespace

// Of surfaces one after another that are close together: a person.
struct MovingThings::Group {
  Eigen::Vector3f first_middle;
  std::vector<Disc> discs;
  Eigen::AlignedBox3f bounds;
};

MovingThings::MovingThings(const std::vector<Rectangle>& rectangles, const Light& light)
    : rectangles_(rectangles), light_(light), corner_lights_(rectangles.size()) {
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

MovingThings::CornerLight MovingThings::light_at_corners(const Rectangle& r) const {
  constexpr float kSmall_m = 0.25F;
  constexpr float kOffSurface_m = 1e-3F;
  const auto light_at = [&](float right_ratio, float up_ratio) {
    const Eigen::Vector3f on_it =
        r.at(r.size_m.cwiseProduct(Eigen::Vector2f(right_ratio, up_ratio)));
    return light_.falling_on({on_it + kOffSurface_m * r.normal(), r.normal()});
  };
  CornerLight light;
  if (r.size_m.maxCoeff() < kSmall_m) {
    light.fill(light_at(0.5F, 0.5F));
  } else {
    light = {light_at(0, 0), light_at(1, 0), light_at(0, 1), light_at(1, 1)};
  }
  return light;
}

Colour MovingThings::light_at(int index, const Eigen::Vector2f& right_up_m) {
  const Rectangle& r = rectangle(index);
  auto& light = corner_lights_[static_cast<std::size_t>(index)];
  if (!light) light = light_at_corners(r);
  const Eigen::Vector2f ratio = right_up_m.cwiseQuotient(r.size_m);
  const Colour lower = (*light)[0] + ratio.x() * ((*light)[1] - (*light)[0]);
  const Colour upper = (*light)[2] + ratio.x() * ((*light)[3] - (*light)[2]);
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
