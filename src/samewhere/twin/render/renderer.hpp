#pragma once

#include <vector>

#include <opencv2/core/mat.hpp>

#include <samewhere/core/rig.hpp>
#include <samewhere/core/rigid3.hpp>
#include <samewhere/twin/building/building.hpp>
#include <samewhere/twin/building/surface.hpp>
#include <samewhere/twin/render/light.hpp>
#include <samewhere/twin/render/moving_things.hpp>
#include <samewhere/twin/render/ray_scene.hpp>

namespace samewhere::twin {

// What a perfect camera sees; pictures of the camera's size.
struct View {
  cv::Mat radiance;   // CV_32FC3, linear, blue green red
  cv::Mat depth_m;    // CV_32F, along the optical axis at the pixel's centre, exact
  cv::Mat incidence;  // CV_32F, cosine between the ray and the surface's normal: 0 is grazing
  // CV_32S, index of the rectangle, -1 if none. Moving things count on after those of the building.
  cv::Mat surface;
};

// Casts a ray through the centre of every pixel of the (distorted) picture. Textures are filtered
// within a surface; where neighbouring pixels see different surfaces, more rays find out how much
// of the pixel each of them covers. Any number of threads may use it at once. Cameras of a rig that
// are alike can share one.
class Renderer {
 public:
  // Building and rays must outlive the renderer. Computes the light on all surfaces: a fraction of
  // a second for a floor.
  Renderer(const Building& building, const RayScene& rays, const core::Camera& camera,
           int num_threads);

  View render(const core::Rigid3& world_from_camera) const { return render(world_from_camera, {}); }
  // With things that are not part of the building, say people: they are lit by what surrounds them
  // and keep light from what is close to them.
  View render(const core::Rigid3& world_from_camera, const std::vector<Rectangle>& moving) const;

  // What a camera's light meter reads there: mean radiance of a coarse picture, without textures;
  // lamps count as a little more than white.
  float mean_radiance(const core::Rigid3& world_from_camera) const;

 private:
  struct Eye;
  struct Run;

  void render_row(const Eye& eye, MovingThings& moving, int y, View& view) const;
  void shade_run(const Eye& eye, MovingThings& moving, const Run& run, View& view) const;
  void mirror_in_run(const Eye& eye, const Run& run, View& view) const;
  Colour blurred(const Ray& axis, const Eigen::Vector3f& normal, float half_angle_rad,
                 float brightest) const;
  Colour mirrored(const Ray& ray, const Hit& hit) const;
  Colour without_texture(const Ray& ray, const Hit& hit) const;
  void darken_run(const Eye& eye, const MovingThings& moving, const Run& run, View& view) const;
  void smooth_edges(const Eye& eye, const MovingThings& moving, View& view) const;
  cv::Vec3f smooth_pixel(const Eye& eye, const MovingThings& moving, const View& view,
                         const cv::Point& pixel) const;
  Eigen::Vector3f ray(float x_px, float y_px) const;
  const Rectangle& rectangle(const MovingThings& moving, int surface) const;

  const Building& building_;
  const RayScene& rays_;
  Light light_;
  int width_px_ = 0;
  int height_px_ = 0;
  float pixel_rad_ = 0.0F;
  // through the centres of the pixels and one more column and row: z = 1
  std::vector<Eigen::Vector3f> rays_in_camera_;
};

}  // namespace samewhere::twin
