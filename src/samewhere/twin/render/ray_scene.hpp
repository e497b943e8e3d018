#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <samewhere/twin/render/ray.hpp>

namespace samewhere::twin {

struct Hit {
  int rectangle = -1;  // index, -1: nothing
  float reach = 0.0F;  // in lengths of the direction
};

// Whether the program was built with a tracer of rays (-DSAMEWHERE_TWIN=ON). Without one the
// constructor of RayScene throws InputError.
bool can_render();

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
