#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <samewhere/twin/surface.hpp>

namespace samewhere::twin {

struct Ray {
  Eigen::Vector3f origin = Eigen::Vector3f::Zero();      // metres
  Eigen::Vector3f direction = Eigen::Vector3f::UnitX();  // of any length
};

struct Hit {
  int rectangle = -1;  // index, -1: nothing
  float reach = 0.0F;  // in lengths of the direction
};

// Where the ray meets the plane of the rectangle, in lengths of the direction; not finite if it
// runs along it.
float reach_of_plane(const Ray& ray, const Rectangle& rectangle);

// Where the ray meets the rectangle, in lengths of the direction; nothing if it misses it.
std::optional<float> reach_of(const Ray& ray, const Rectangle& rectangle);

// Answers which rectangle a ray meets first (Embree; Wald et al. 2014). Any number of threads may
// ask at once. The rectangles must outlive it and stay where they are.
class RayScene {
 public:
  explicit RayScene(const std::vector<Rectangle>& rectangles);
  RayScene(RayScene&&) noexcept;
  RayScene& operator=(RayScene&&) noexcept;
  ~RayScene();

  std::optional<Hit> first_hit(const Ray& ray) const;
  // The same for many rays with one origin, eight at once: neighbours should run alike. As many
  // hits as directions; a rectangle of -1 where nothing is met.
  void first_hits(const Eigen::Vector3f& origin, std::span<const Eigen::Vector3f> directions,
                  std::span<Hit> hits) const;
  // Whether anything stands between the origin and origin + direction.
  bool is_blocked(const Ray& ray) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace samewhere::twin
