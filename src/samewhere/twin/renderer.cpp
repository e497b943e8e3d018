#include <cmath>
#include <limits>

#include <samewhere/geometry/camera.hpp>
#include <samewhere/twin/renderer.hpp>
#include <samewhere/twin/texture.hpp>

namespace samewhere::twin {
namespace {

// a pixel on a surface seen at a grazing angle is long and narrow; textures are filtered by one
// length in between, and no longer than this many times the narrow one
constexpr float kMaxStretch = 3.0F;
// beyond white: a lamp in a part of a pixel does not outshine the rest of it
constexpr float kBrightest = 1.5F;

bool is_edge(const cv::Mat& surface, const cv::Point& at) {
  const int here = surface.at<int>(at);
  return surface.at<int>(at.y, at.x - 1) != here || surface.at<int>(at.y, at.x + 1) != here ||
         surface.at<int>(at.y - 1, at.x) != here || surface.at<int>(at.y + 1, at.x) != here;
}

}  // namespace

struct Renderer::Eye {
  Eigen::Matrix3f world_from_camera;
  Eigen::Vector3f position;
};

struct Renderer::Sample {
  Colour radiance = Colour::Zero();
  float depth_m = 0.0F;
  float incidence = 0.0F;
  int surface = -1;
};

Renderer::Renderer(const Building& building, const RayScene& rays, const core::Camera& camera)
    : building_(building),
      rays_(rays),
      light_(light_on(building.rectangles, rays)),
      width_px_(geometry::pinhole(camera).width_px),
      height_px_(geometry::pinhole(camera).height_px),
      pixel_rad_(static_cast<float>(1.0 / geometry::focal_px(camera))) {
  for (int y = 0; y <= height_px_; ++y) {
    for (int x = 0; x <= width_px_; ++x) {
      const Eigen::Vector3d bearing = geometry::bearing(camera, {x, y});
      rays_in_camera_.emplace_back((bearing / bearing.z()).cast<float>());
    }
  }
}

// Between the centres of pixels, linearly.
Eigen::Vector3f Renderer::ray(float x_px, float y_px) const {
  const int column = static_cast<int>(x_px);
  const int row = static_cast<int>(y_px);
  const auto at = static_cast<std::size_t>(row * (width_px_ + 1) + column);
  const auto below = at + static_cast<std::size_t>(width_px_ + 1);
  const Eigen::Vector3f& start = rays_in_camera_[at];
  return start + (x_px - static_cast<float>(column)) * (rays_in_camera_[at + 1] - start) +
         (y_px - static_cast<float>(row)) * (rays_in_camera_[below] - start);
}

Renderer::Sample Renderer::sample(const Eye& eye, const Eigen::Vector3f& ray_in_camera) const {
  const Ray ray{eye.position, eye.world_from_camera * ray_in_camera};
  const std::optional<Hit> hit = rays_.first_hit(ray);
  if (!hit) return {};
  const Rectangle& rectangle = building_.rectangles[static_cast<std::size_t>(hit->rectangle)];
  const Eigen::Vector2f uv = rectangle.right_up_m(ray.origin + hit->reach * ray.direction);
  const float incidence =
      std::abs(ray.direction.dot(rectangle.normal())) / std::sqrt(ray.direction.squaredNorm());
  const float stretch = std::min(1.0F / std::sqrt(incidence), kMaxStretch);
  const TexturePoint point{uv.x(), uv.y(), hit->reach * pixel_rad_ * stretch};
  const Colour shade = reflectance(rectangle, point);
  const Colour light = is_emitting(rectangle.material)
                           ? Colour::Constant(rectangle.material.radiance)
                           : light_.at(hit->rectangle, uv);
  return {shade * light, hit->reach, incidence, hit->rectangle};
}

void Renderer::render_pixels(const Eye& eye, View& view) const {
  for (int y = 0; y < height_px_; ++y) {
    auto* const radiance = view.radiance.ptr<cv::Vec3f>(y);
    auto* const depth_m = view.depth_m.ptr<float>(y);
    auto* const incidence = view.incidence.ptr<float>(y);
    auto* const surface = view.surface.ptr<int>(y);
    const Eigen::Vector3f* const rays =
        &rays_in_camera_[static_cast<std::size_t>(y * (width_px_ + 1))];
    for (int x = 0; x < width_px_; ++x) {
      const Sample seen = sample(eye, rays[x]);
      radiance[x] = {seen.radiance[0], seen.radiance[1], seen.radiance[2]};
      depth_m[x] = seen.depth_m;
      incidence[x] = seen.incidence;
      surface[x] = seen.surface;
    }
  }
}

// The colour of a pixel that several surfaces share: each gives that of the nearest pixel around
// that shows it.
cv::Vec3f Renderer::smooth_pixel(const Eye& eye, const View& view, const cv::Point& pixel) const {
  // a turned square, so that upright and level edges take five steps rather than three
  constexpr float kOffsets_px[4][2] = {
      {0.375F, 0.125F}, {-0.125F, 0.375F}, {-0.375F, -0.125F}, {0.125F, -0.375F}};
  const cv::Point neighbours[5] = {pixel, pixel + cv::Point(1, 0), pixel - cv::Point(1, 0),
                                   pixel + cv::Point(0, 1), pixel - cv::Point(0, 1)};
  cv::Vec3f sum(0.0F, 0.0F, 0.0F);
  for (const auto& offset_px : kOffsets_px) {
    const Ray through{eye.position,
                      eye.world_from_camera * ray(static_cast<float>(pixel.x) + offset_px[0],
                                                  static_cast<float>(pixel.y) + offset_px[1])};
    cv::Point nearest = pixel;
    float nearest_reach = std::numeric_limits<float>::infinity();
    for (const auto& neighbour : neighbours) {
      const int surface = view.surface.at<int>(neighbour);
      if (surface < 0) continue;
      const auto reach = reach_of(through, building_.rectangles[static_cast<std::size_t>(surface)]);
      if (!reach || *reach >= nearest_reach) continue;
      nearest = neighbour;
      nearest_reach = *reach;
    }
    const cv::Vec3f& colour = view.radiance.at<cv::Vec3f>(nearest);
    for (int i = 0; i < 3; ++i) sum[i] += std::min(colour[i], kBrightest);
  }
  return 0.25F * sum;
}

void Renderer::smooth_edges(const Eye& eye, View& view) const {
  cv::Mat smooth = view.radiance.clone();
  for (int y = 1; y + 1 < height_px_; ++y) {
    for (int x = 1; x + 1 < width_px_; ++x) {
      const cv::Point pixel(x, y);
      if (!is_edge(view.surface, pixel)) continue;
      smooth.at<cv::Vec3f>(pixel) = smooth_pixel(eye, view, pixel);
    }
  }
  view.radiance = smooth;
}

View Renderer::render(const core::Rigid3& world_from_camera) const {
  const Eye eye{world_from_camera.rotation.toRotationMatrix().cast<float>(),
                world_from_camera.translation.cast<float>()};
  View view{.radiance = cv::Mat(height_px_, width_px_, CV_32FC3),
            .depth_m = cv::Mat(height_px_, width_px_, CV_32F),
            .incidence = cv::Mat(height_px_, width_px_, CV_32F),
            .surface = cv::Mat(height_px_, width_px_, CV_32S)};
  render_pixels(eye, view);
  smooth_edges(eye, view);
  return view;
}

}  // namespace samewhere::twin
