#pragma once

#include <span>
#include <vector>

#include <samewhere/twin/building/surface.hpp>
#include <samewhere/twin/render/ray_scene.hpp>
#include <samewhere/twin/render/surface_colours.hpp>

namespace samewhere::twin {

struct SurfacePoint {
  Eigen::Vector3f position = Eigen::Vector3f::Zero();  // metres, a hair in front of the surface
  Eigen::Vector3f normal = Eigen::Vector3f::UnitZ();
};

// A small piece of a lamp or window.
struct Emitter {
  SurfacePoint at;
  Colour power = Colour::Zero();  // radiance times area over pi
  float area_m2 = 0.0F;
};

// How much light falls on every surface: from lamps and windows with soft shadows, and by way of
// the other surfaces (one bounce gathered, the further ones estimated from it). As irradiance over
// pi: times the reflectance it is the light that a matt surface sends back. Computed once, on a
// grid that is finer where light changes; the same whatever the number of threads.
class Light {
 public:
  // Rectangles and rays must outlive it.
  Light(const std::vector<Rectangle>& rectangles, const RayScene& rays, int num_threads);

  // `right_up_m`: of a point of the rectangle, from its corner.
  Colour at(int rectangle, const Eigen::Vector2f& right_up_m) const {
    return on_surfaces_.at(rectangle, right_up_m);
  }
  // On a thing that is not among the rectangles, from what surrounds it.
  Colour falling_on(const SurfacePoint& point) const;

 private:
  // For every grid point the value that `compute` gives for it; points that are covered by another
  // thing take the mean of their neighbours.
  template <class Compute>
  void fill(SurfaceColours& colours, const Compute& compute) const;
  template <class Compute>
  void fill_rectangle(SurfaceColours& colours, int rectangle, const Compute& compute) const;
  template <class Compute>
  Colour value_at_point(const Eigen::Vector2f& right_up_m, int rectangle,
                        const Compute& compute) const;
  bool covers(const SurfacePoint& point) const;
  Colour light_from(const Emitter& emitter, const SurfacePoint& point) const;
  Colour light_from(const std::vector<Emitter>& emitters, const SurfacePoint& point) const;
  // Those that may shine on points within a distance of this one.
  std::vector<Emitter> emitters_near(const SurfacePoint& point, float distance_m) const;
  // Mean light that arrives from the surfaces around, lit as `light` says.
  Colour gathered(const SurfacePoint& point, std::span<const Eigen::Vector3f> around_z,
                  const SurfaceColours& light) const;

  const std::vector<Rectangle>& rectangles_;
  const RayScene& rays_;
  int num_threads_;
  std::vector<Emitter> emitters_;  // by x
  SurfaceColours on_surfaces_;
};

}  // namespace samewhere::twin
