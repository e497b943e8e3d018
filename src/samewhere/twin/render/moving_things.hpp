#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <samewhere/twin/building/surface.hpp>
#include <samewhere/twin/render/light.hpp>
#include <samewhere/twin/render/ray_scene.hpp>

namespace samewhere::twin {

// Things that stand in a building for one picture only, say people: where rays meet them, the light
// on them and the light that they keep from what is close to them. One thread at a time.
class MovingThings {
 public:
  // Rectangles and light must outlive it.
  MovingThings(const std::vector<Rectangle>& rectangles, const Light& light);
  ~MovingThings();
  MovingThings(const MovingThings&) = delete;
  MovingThings& operator=(const MovingThings&) = delete;

  bool is_empty() const { return rectangles_.empty(); }
  const Rectangle& rectangle(int index) const {
    return rectangles_[static_cast<std::size_t>(index)];
  }

  // Of rays with one origin: the nearer of what each has met so far and of these things, which
  // count from `first_index` on.
  void meet(const Eigen::Vector3f& origin, std::span<const Eigen::Vector3f> directions,
            int first_index, std::span<Hit> hits) const;

  // At a point of one of them. As of Light: irradiance over pi.
  Colour light_at(int index, const Eigen::Vector2f& right_up_m);

  // Share of its light that the things leave to a point of the building, by how much of what it
  // sees they fill (surfaces as discs: Bunnell, Dynamic Ambient Occlusion, GPU Gems 2, 2005).
  float share_left(const SurfacePoint& point) const;

 private:
  struct Group;
  enum class Side : std::uint8_t { kLeft, kRight };
  using SideLight = std::array<Colour, 2>;  // at its lower and upper end

  Colour light_at_side(const Rectangle& r, Side side, float up_ratio) const;
  SideLight light_along(const Rectangle& r, Side side) const;
  const SideLight& side_light(int index, Side side);

  const std::vector<Rectangle>& rectangles_;
  const Light& light_;
  std::optional<RayScene> rays_;
  std::vector<Group> groups_;
  // left and right of each, where asked for
  std::vector<std::array<std::optional<SideLight>, 2>> side_lights_;
};

}  // namespace samewhere::twin
