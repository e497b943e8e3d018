#include <algorithm>
#include <cmath>
#include <numbers>

#include <samewhere/twin/light.hpp>
#include <samewhere/twin/texture.hpp>

namespace samewhere::twin {
namespace {

constexpr float kOffSurface_m = 1e-3F;
constexpr float kEmitterRange_m = 7.0F;
constexpr int kNumGatherRays = 32;
// light of all bounces over that of the first, in a corridor whose surfaces reflect 40 %
constexpr float kAllBounces = 1.0F / (1.0F - 0.4F);
constexpr float kPi = std::numbers::pi_v<float>;
// a grid point with another thing in front of it has no light of its own
const Colour kBuried = Colour::Constant(-1.0F);

const Colour kShade = Colour::Constant(0.1F);

bool is_buried(const Colour& colour) { return colour[0] < 0.0F; }

struct SurfacePoint {
  Eigen::Vector3f position = Eigen::Vector3f::Zero();  // a hair in front of the surface
  Eigen::Vector3f normal = Eigen::Vector3f::UnitZ();
};

// A small piece of a lamp or window.
struct Emitter {
  SurfacePoint at;
  Colour power = Colour::Zero();  // radiance times area over pi
};

std::vector<Emitter> emitters_of(const std::vector<Rectangle>& rectangles) {
  constexpr float kPiece_m = 0.4F;
  std::vector<Emitter> emitters;
  for (const auto& r : rectangles) {
    if (!is_emitting(r.material)) continue;
    const Eigen::Array2f num_pieces = (r.size_m.array() / kPiece_m).ceil();
    const Eigen::Vector2f piece_m = r.size_m.array() / num_pieces;
    const Colour power =
        mean_reflectance(r.material) * (r.material.radiance * piece_m.prod() / kPi);
    for (float v = 0.5F; v < num_pieces.y(); v += 1.0F) {
      for (float u = 0.5F; u < num_pieces.x(); u += 1.0F) {
        const Eigen::Vector3f position = r.at(Eigen::Vector2f(u, v).cwiseProduct(piece_m));
        emitters.push_back({{position + kOffSurface_m * r.normal(), r.normal()}, power});
      }
    }
  }
  return emitters;
}

Colour light_from(const Emitter& emitter, const SurfacePoint& point, const RayScene& rays) {
  const Eigen::Vector3f to_emitter = emitter.at.position - point.position;
  const float squared_m2 = to_emitter.squaredNorm();
  const float cosines =
      point.normal.dot(to_emitter) * -emitter.at.normal.dot(to_emitter) / squared_m2;
  if (point.normal.dot(to_emitter) <= 0.0F || cosines <= 0.0F) return Colour::Zero();
  const float window = 1.0F - squared_m2 / (kEmitterRange_m * kEmitterRange_m);
  if (window <= 0.0F || rays.is_blocked({point.position, to_emitter})) return Colour::Zero();
  constexpr float kPieceSize_m2 = 0.02F;  // tames pieces very close by
  return emitter.power * (cosines * window / (squared_m2 + kPieceSize_m2));
}

Colour light_from_all(const std::vector<Emitter>& emitters, const SurfacePoint& point,
                      const RayScene& rays) {
  Colour sum = Colour::Zero();
  for (const auto& emitter : emitters) sum += light_from(emitter, point, rays);
  return sum;
}

// Directions around +z, spread evenly with a density that follows the cosine (a Fibonacci spiral on
// the disc, lifted onto the hemisphere). The same everywhere, so that neighbours do not differ by
// chance.
std::vector<Eigen::Vector3f> gather_directions() {
  constexpr float kGoldenAngle_rad = 2.3999632F;
  std::vector<Eigen::Vector3f> directions;
  for (int i = 0; i < kNumGatherRays; ++i) {
    const float squared = (static_cast<float>(i) + 0.5F) / static_cast<float>(kNumGatherRays);
    const float angle_rad = kGoldenAngle_rad * static_cast<float>(i);
    directions.emplace_back(std::sqrt(squared) * std::cos(angle_rad),
                            std::sqrt(squared) * std::sin(angle_rad), std::sqrt(1.0F - squared));
  }
  return directions;
}

class Baker {
 public:
  Baker(const std::vector<Rectangle>& rectangles, const RayScene& rays)
      : rectangles_(rectangles),
        rays_(rays),
        emitters_(emitters_of(rectangles)),
        directions_(gather_directions()) {}

  // For every grid point: the value that `compute` gives for it. Buried points take the mean of
  // their neighbours.
  template <class Compute>
  SurfaceColours fill(const Compute& compute) const {
    SurfaceColours colours(rectangles_);
    for (int r = 0; r < static_cast<int>(rectangles_.size()); ++r) {
      for (int row = 0; row < colours.num_rows(r); ++row) {
        for (int column = 0; column < colours.num_columns(r); ++column) {
          const SurfacePoint point = surface_point(r, colours.position(r, column, row));
          colours.value(r, column, row) = covers(point) ? kBuried : compute(r, point);
        }
      }
      uncover(colours, r);
    }
    return colours;
  }

  Colour direct(const SurfacePoint& point) const { return light_from_all(emitters_, point, rays_); }

  // Mean light that arrives from the surfaces around, lit as `light` says.
  Colour gathered(int rectangle, const SurfacePoint& point, const SurfaceColours& light) const {
    const Rectangle& r = rectangles_[static_cast<std::size_t>(rectangle)];
    Colour sum = Colour::Zero();
    for (const auto& around_z : directions_) {
      const Eigen::Vector3f direction =
          around_z.x() * r.right + around_z.y() * r.up + around_z.z() * point.normal;
      const auto hit = rays_.first_hit({point.position, direction});
      if (!hit) continue;
      const Rectangle& seen = rectangles_[static_cast<std::size_t>(hit->rectangle)];
      if (is_emitting(seen.material)) continue;  // direct light already
      const Eigen::Vector3f position = point.position + hit->reach * direction;
      sum += mean_reflectance(seen.material) * light.at(hit->rectangle, seen.right_up_m(position));
    }
    return sum / static_cast<float>(kNumGatherRays);
  }

 private:
  SurfacePoint surface_point(int rectangle, const Eigen::Vector2f& right_up_m) const {
    const Rectangle& r = rectangles_[static_cast<std::size_t>(rectangle)];
    return {r.at(right_up_m) + kOffSurface_m * r.normal(), r.normal()};
  }

  // Whether something stands on this point: straight ahead one then sees its back from within.
  bool covers(const SurfacePoint& point) const {
    const auto hit = rays_.first_hit({point.position, point.normal});
    if (!hit) return true;
    const Rectangle& seen = rectangles_[static_cast<std::size_t>(hit->rectangle)];
    return seen.normal().dot(point.normal) > 0.0F;
  }

  // Light from the edges into the buried points. Faces that are buried altogether are in the
  // shade: an edge of them may still look out.
  static void uncover(SurfaceColours& colours, int r) {
    constexpr int kMaxSteps = 64;
    bool is_done = false;
    for (int step = 0; !is_done && step < kMaxSteps; ++step) is_done = spread(colours, r);
    if (is_done) return;
    for (int row = 0; row < colours.num_rows(r); ++row) {
      for (int column = 0; column < colours.num_columns(r); ++column) {
        Colour& value = colours.value(r, column, row);
        if (is_buried(value)) value = kShade;
      }
    }
  }

  // One step of light into buried points; true if none is left.
  static bool spread(SurfaceColours& colours, int r);

  const std::vector<Rectangle>& rectangles_;
  const RayScene& rays_;
  std::vector<Emitter> emitters_;
  std::vector<Eigen::Vector3f> directions_;
};

// Mean of the neighbours of a grid point that are not buried; buried if all are.
Colour mean_of_neighbours(SurfaceColours& colours, int r, const Eigen::Vector2i& at) {
  Colour sum = Colour::Zero();
  float num_lit = 0.0F;
  const int last_row = std::min(at.y() + 1, colours.num_rows(r) - 1);
  const int last_column = std::min(at.x() + 1, colours.num_columns(r) - 1);
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

bool Baker::spread(SurfaceColours& colours, int r) {
  bool is_done = true;
  std::vector<std::pair<Eigen::Vector2i, Colour>> found;
  for (int row = 0; row < colours.num_rows(r); ++row) {
    for (int column = 0; column < colours.num_columns(r); ++column) {
      if (!is_buried(colours.value(r, column, row))) continue;
      found.emplace_back(Eigen::Vector2i(column, row),
                         mean_of_neighbours(colours, r, {column, row}));
      is_done = is_done && !is_buried(found.back().second);
    }
  }
  for (const auto& [at, colour] : found) colours.value(r, at.x(), at.y()) = colour;
  return is_done;
}

}  // namespace

SurfaceColours light_on(const std::vector<Rectangle>& rectangles, const RayScene& rays) {
  const Baker baker(rectangles, rays);
  const SurfaceColours direct =
      baker.fill([&](int, const SurfacePoint& p) { return baker.direct(p); });
  return baker.fill([&](int r, const SurfacePoint& p) -> Colour {
    const Rectangle& rectangle = rectangles[static_cast<std::size_t>(r)];
    return direct.at(r, rectangle.right_up_m(p.position)) +
           kAllBounces * baker.gathered(r, p, direct);
  });
}

}  // namespace samewhere::twin
