#include <algorithm>
#include <array>
#include <cmath>

#include <samewhere/core/share_out.hpp>
#include <samewhere/twin/building/angles.hpp>
#include <samewhere/twin/render/light.hpp>
#include <samewhere/twin/render/texture.hpp>

namespace samewhere::twin {
namespace {

constexpr float kOffSurface_m = 1e-3F;
constexpr float kEmitterRange_m = 7.0F;
constexpr int kNumBakeRays = 32;
constexpr int kNumMovingRays = 16;
// light of all bounces over that of the first, in a corridor whose surfaces reflect 40 %
constexpr float kAllBounces = 1.0F / (1.0F - 0.4F);
// a grid point with another thing in front of it has no light of its own
const Colour kBuried = Colour::Constant(-1.0F);
const Colour kShade = Colour::Constant(0.1F);

bool is_buried(const Colour& colour) { return colour[0] < 0.0F; }

// What a window sends into the room over what one sees of it: slats and cloth throw daylight onto
// floor and ceiling rather than into eyes.
float thrown_over_seen(Finish finish) {
  constexpr float kWindow = 2.5F;
  return finish == Finish::kBlinds || finish == Finish::kView ? kWindow : 1.0F;
}

std::vector<Emitter> emitters_of(const std::vector<Rectangle>& rectangles) {
  constexpr float kPiece_m = 0.4F;
  std::vector<Emitter> emitters;
  for (const auto& r : rectangles) {
    if (!is_emitting(r.material)) continue;
    const Eigen::Array2f num_pieces = (r.size_m.array() / kPiece_m).ceil();
    const Eigen::Vector2f piece_m = r.size_m.array() / num_pieces;
    const float radiance = thrown_over_seen(r.material.finish) * r.material.radiance;
    const Colour power = mean_reflectance(r.material) * (radiance * piece_m.prod() / kPi_f);
    for (float v = 0.5F; v < num_pieces.y(); v += 1.0F) {
      for (float u = 0.5F; u < num_pieces.x(); u += 1.0F) {
        const Eigen::Vector3f position = r.at(Eigen::Vector2f(u, v).cwiseProduct(piece_m));
        emitters.push_back(
            {{position + kOffSurface_m * r.normal(), r.normal()}, power, piece_m.prod()});
      }
    }
  }
  std::stable_sort(emitters.begin(), emitters.end(), [](const Emitter& a, const Emitter& b) {
    return a.at.position.x() < b.at.position.x();
  });
  return emitters;
}

// Directions around +z, spread evenly with a density that follows the cosine (a Fibonacci spiral on
// the disc, lifted onto the hemisphere). The same everywhere, so that neighbours do not differ by
// chance.
template <int kCount>
std::array<Eigen::Vector3f, kCount> directions_around_z() {
  constexpr float kGoldenAngle_rad = 2.3999632F;
  std::array<Eigen::Vector3f, kCount> directions;
  for (int i = 0; i < kCount; ++i) {
    const float squared = (static_cast<float>(i) + 0.5F) / static_cast<float>(kCount);
    const float angle_rad = kGoldenAngle_rad * static_cast<float>(i);
    directions[static_cast<std::size_t>(i)] = {std::sqrt(squared) * std::cos(angle_rad),
                                               std::sqrt(squared) * std::sin(angle_rad),
                                               std::sqrt(1.0F - squared)};
  }
  return directions;
}

// Two directions in the surface, the same for all surfaces that look the same way.
Eigen::Matrix3f world_from_surface(const Eigen::Vector3f& normal) {
  const bool is_upright = std::abs(normal.z()) > 0.9F;
  const Eigen::Vector3f other = is_upright ? Eigen::Vector3f::UnitX() : Eigen::Vector3f::UnitZ();
  Eigen::Matrix3f axes;
  axes.col(2) = normal;
  axes.col(0) = other.cross(normal).normalized();
  axes.col(1) = normal.cross(axes.col(0));
  return axes;
}

SurfacePoint surface_point(const Rectangle& r, const Eigen::Vector2f& right_up_m) {
  return {r.at(right_up_m) + kOffSurface_m * r.normal(), r.normal()};
}

// Mean of the neighbours of a grid point that are not buried; buried if all are.
Colour mean_of_neighbours(SurfaceColours& colours, int r, const Eigen::Vector2i& at) {
  Colour sum = Colour::Zero();
  float num_lit = 0.0F;
  const int last_row = std::min(at.y() + 1, colours.rows(r).num_points - 1);
  const int last_column = std::min(at.x() + 1, colours.columns(r).num_points - 1);
  for (int row = std::max(at.y() - 1, 0); row <= last_row; ++row) {
    for (int column = std::max(at.x() - 1, 0); column <= last_column; ++column) {
      const Colour& value = colours.value(r, column, row);
      if (is_buried(value)) continue;
      sum += value;
      num_lit += 1.0F;
    }
  }
  return num_lit > 0.0F ? Colour(sum / num_lit) : kBuried;
}

template <class Visit>
void for_each_point(const SurfaceColours& colours, int r, const Visit& visit) {
  for (int row = 0; row < colours.rows(r).num_points; ++row) {
    for (int column = 0; column < colours.columns(r).num_points; ++column) visit(column, row);
  }
}

// One step of light into buried points; true if none is left.
bool spread(SurfaceColours& colours, int r) {
  bool is_done = true;
  std::vector<std::pair<Eigen::Vector2i, Colour>> found;
  for_each_point(colours, r, [&](int column, int row) {
    if (!is_buried(colours.value(r, column, row))) return;
    found.emplace_back(Eigen::Vector2i(column, row), mean_of_neighbours(colours, r, {column, row}));
    is_done = is_done && !is_buried(found.back().second);
  });
  for (const auto& [at, colour] : found) colours.value(r, at.x(), at.y()) = colour;
  return is_done;
}

// Light from the edges into the buried points. Faces that are buried altogether are in the shade:
// an edge of them may still look out.
void uncover(SurfaceColours& colours, int r) {
  constexpr int kMaxSteps = 64;
  bool is_done = false;
  for (int step = 0; !is_done && step < kMaxSteps; ++step) is_done = spread(colours, r);
  if (is_done) return;
  for_each_point(colours, r, [&](int column, int row) {
    Colour& value = colours.value(r, column, row);
    if (is_buried(value)) value = kShade;
  });
}

// The value between points of a coarser grid that are `step` apart; nothing if they differ so much
// that light changes there.
std::optional<Colour> between(SurfaceColours& colours, int r, const Eigen::Array2i& at,
                              const Eigen::Array2i& step) {
  constexpr float kAlike_ratio = 0.06F;
  constexpr float kAlike = 0.004F;
  const Eigen::Array2i low = at / step * step;
  const Eigen::Array2i high = low + (at - low).min(1) * step;
  const std::array<Colour, 4> corners = {
      colours.value(r, low.x(), low.y()), colours.value(r, high.x(), low.y()),
      colours.value(r, low.x(), high.y()), colours.value(r, high.x(), high.y())};
  Colour least = corners[0];
  Colour most = corners[0];
  for (const auto& corner : corners) {
    least = least.min(corner);
    most = most.max(corner);
  }
  if (is_buried(least) || (most - least > kAlike + kAlike_ratio * most).any()) return std::nullopt;
  return 0.25F * (corners[0] + corners[1] + corners[2] + corners[3]);
}

// Between points of a grid, columns and rows.
struct Steps {
  Eigen::Array2i fine = Eigen::Array2i::Ones();
  Eigen::Array2i coarser = Eigen::Array2i::Zero();  // of the grid before it; 0: there was none
};

// The points of the fine grid that were not on the coarser one.
template <class Visit>
void for_each_new_point(const SurfaceColours& colours, int r, const Steps& steps,
                        const Visit& visit) {
  for (int row = 0; row < colours.rows(r).num_points; row += steps.fine.y()) {
    for (int column = 0; column < colours.columns(r).num_points; column += steps.fine.x()) {
      const Eigen::Array2i at(column, row);
      const bool is_new =
          steps.coarser.x() == 0 || (at != at / steps.coarser * steps.coarser).any();
      if (is_new) visit(at);
    }
  }
}

// How much of what one sees a surface at this distance fills at most, roughly: as a disc. A ray
// stands for an equal share of what there is to see; a thing that fills less of it, a sign or a
// leaf, must not count for all of that, or it paints a blotch wherever a ray happens to meet it.
float share_filled(const Rectangle& r, float distance_m) {
  const float area_m2 = r.size_m.prod();
  return area_m2 / (kPi_f * distance_m * distance_m + area_m2);
}

// What follows from points that are known already.
std::optional<Colour> known_value(SurfaceColours& colours, int r, const Eigen::Array2i& at,
                                  const Eigen::Array2i& coarser) {
  if (colours.columns(r).is_thin && at.x() > 0) return colours.value(r, 0, at.y());
  if (colours.rows(r).is_thin && at.y() > 0) return colours.value(r, at.x(), 0);
  return coarser.x() > 0 ? between(colours, r, at, coarser) : std::nullopt;
}

}  // namespace

Light::Light(const std::vector<Rectangle>& rectangles, const RayScene& rays, int num_threads)
    : rectangles_(rectangles),
      rays_(rays),
      num_threads_(num_threads),
      emitters_(emitters_of(rectangles)),
      on_surfaces_(rectangles) {
  SurfaceColours direct(rectangles);
  fill(direct, [this](int r) {
    const Rectangle& rectangle = rectangles_[static_cast<std::size_t>(r)];
    const auto emitters = emitters_near(surface_point(rectangle, 0.5F * rectangle.size_m),
                                        0.5F * rectangle.size_m.norm());
    return [this, emitters](const SurfacePoint& p) { return light_from(emitters, p); };
  });
  const auto directions = directions_around_z<kNumBakeRays>();
  fill(on_surfaces_,
       [&](int) { return [&](const SurfacePoint& p) { return gathered(p, directions, direct); }; });
  for (int r = 0; r < static_cast<int>(rectangles.size()); ++r) {
    for_each_point(direct, r, [&](int column, int row) {
      Colour& value = on_surfaces_.value(r, column, row);
      value = direct.value(r, column, row) + kAllBounces * value;
    });
  }
}

template <class Compute>
void Light::fill(SurfaceColours& colours, const Compute& compute) const {
  core::share_out(static_cast<int>(rectangles_.size()), num_threads_, [&](int r) {
    if (is_emitting(rectangles_[static_cast<std::size_t>(r)].material)) return;
    fill_rectangle(colours, r, compute(r));
    uncover(colours, r);
  });
}

// From coarse to fine.
template <class Compute>
void Light::fill_rectangle(SurfaceColours& colours, int r, const Compute& compute) const {
  const int column_step = colours.columns(r).coarse_step;
  const int row_step = colours.rows(r).coarse_step;
  Steps steps;
  for (int step = std::max(column_step, row_step); step > 0; step /= 2) {
    steps.fine = {std::min(step, column_step), std::min(step, row_step)};
    for_each_new_point(colours, r, steps, [&](const Eigen::Array2i& at) {
      const auto known = known_value(colours, r, at, steps.coarser);
      colours.value(r, at.x(), at.y()) =
          known ? *known : value_at_point(colours.position(r, at.x(), at.y()), r, compute);
    });
    steps.coarser = steps.fine;
  }
}

template <class Compute>
Colour Light::value_at_point(const Eigen::Vector2f& right_up_m, int r,
                             const Compute& compute) const {
  const SurfacePoint point = surface_point(rectangles_[static_cast<std::size_t>(r)], right_up_m);
  return covers(point) ? kBuried : compute(point);
}

// Whether something stands on this point: straight ahead one then sees its back from within.
bool Light::covers(const SurfacePoint& point) const {
  const auto hit = rays_.first_hit({point.position, point.normal});
  if (!hit) return true;
  const Rectangle& seen = rectangles_[static_cast<std::size_t>(hit->rectangle)];
  return seen.normal().dot(point.normal) > 0.0F;
}

std::vector<Emitter> Light::emitters_near(const SurfacePoint& point, float distance_m) const {
  const float range_m = kEmitterRange_m + distance_m;
  const auto by_x = [](const Emitter& emitter, float x) { return emitter.at.position.x() < x; };
  const float first_x = point.position.x() - range_m;
  std::vector<Emitter> near;
  for (auto emitter = std::lower_bound(emitters_.begin(), emitters_.end(), first_x, by_x);
       emitter != emitters_.end() && emitter->at.position.x() < point.position.x() + range_m;
       ++emitter) {
    const Eigen::Vector3f to_emitter = emitter->at.position - point.position;
    const bool may_shine = to_emitter.squaredNorm() < range_m * range_m &&
                           to_emitter.dot(point.normal) > 0.0F &&
                           -to_emitter.dot(emitter->at.normal) + distance_m > 0.0F;
    if (may_shine) near.push_back(*emitter);
  }
  return near;
}

Colour Light::light_from(const Emitter& emitter, const SurfacePoint& point) const {
  const Eigen::Vector3f to_emitter = emitter.at.position - point.position;
  const float squared_m2 = to_emitter.squaredNorm();
  const float window = 1.0F - squared_m2 / (kEmitterRange_m * kEmitterRange_m);
  if (window <= 0.0F) return Colour::Zero();
  const float cosines =
      point.normal.dot(to_emitter) * -emitter.at.normal.dot(to_emitter) / squared_m2;
  if (point.normal.dot(to_emitter) <= 0.0F || cosines <= 0.0F) return Colour::Zero();
  if (rays_.is_blocked({point.position, to_emitter})) return Colour::Zero();
  // as a disc: however close it is, what it sends is never brighter than it is itself
  return emitter.power * (cosines * window / (squared_m2 + emitter.area_m2 / kPi_f));
}

Colour Light::light_from(const std::vector<Emitter>& emitters, const SurfacePoint& point) const {
  Colour sum = Colour::Zero();
  for (const auto& emitter : emitters) sum += light_from(emitter, point);
  return sum;
}

Colour Light::gathered(const SurfacePoint& point, std::span<const Eigen::Vector3f> around_z,
                       const SurfaceColours& light) const {
  const Eigen::Matrix3f axes = world_from_surface(point.normal);
  std::array<Eigen::Vector3f, kNumBakeRays> directions;
  std::array<Hit, kNumBakeRays> hits;
  for (std::size_t i = 0; i < around_z.size(); ++i) directions[i] = axes * around_z[i];
  rays_.first_hits(point.position, std::span(directions).first(around_z.size()), hits);
  Colour sum = Colour::Zero();
  float sum_weights = 0.0F;
  const float ray_share = 1.0F / static_cast<float>(around_z.size());
  for (std::size_t i = 0; i < around_z.size(); ++i) {
    if (hits[i].rectangle < 0) {
      sum_weights += 1.0F;
      continue;
    }
    const Rectangle& seen = rectangles_[static_cast<std::size_t>(hits[i].rectangle)];
    const float weight = std::min(1.0F, share_filled(seen, hits[i].reach) / ray_share);
    sum_weights += weight;
    if (is_emitting(seen.material)) continue;  // direct light already
    const Eigen::Vector3f position = point.position + hits[i].reach * directions[i];
    sum += weight * mean_reflectance(seen.material) *
           light.at(hits[i].rectangle, seen.right_up_m(position));
  }
  constexpr float kLeastWeight = 1e-6F;  // nothing but slivers is seen
  return sum / std::max(sum_weights, kLeastWeight);
}

Colour Light::falling_on(const SurfacePoint& point) const {
  static const auto directions = directions_around_z<kNumMovingRays>();
  return light_from(emitters_near(point, 0.0F), point) + gathered(point, directions, on_surfaces_);
}

}  // namespace samewhere::twin
