#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include <samewhere/geometry/camera.hpp>
#include <samewhere/twin/building/noise.hpp>
#include <samewhere/twin/render/renderer.hpp>
#include <samewhere/twin/render/texture.hpp>

namespace samewhere::twin {
namespace {

// a pixel on a surface seen at a grazing angle is long and narrow; textures are filtered by one
// length in between, and no longer than this many times the narrow one
constexpr float kMaxStretch = 3.0F;
// beyond white: a lamp in a part of a pixel does not outshine the rest of it
constexpr float kBrightest = 1.5F;

bool is_edge(const cv::Mat& surface, const cv::Point& at) {
  const int* const row = surface.ptr<int>(at.y);
  const int here = row[at.x];
  return row[at.x - 1] != here || row[at.x + 1] != here ||
         surface.ptr<int>(at.y - 1)[at.x] != here || surface.ptr<int>(at.y + 1)[at.x] != here;
}

}  // namespace

struct Renderer::Eye {
  Eigen::Matrix3f world_from_camera;
  Eigen::Vector3f position;
};

// Neighbouring pixels of a row that see the same rectangle.
struct Renderer::Run {
  int y = 0;
  int first_x = 0;
  std::span<const Eigen::Vector3f> directions;
  std::span<const Hit> hits;

  int surface() const { return hits.front().rectangle; }
};

Renderer::Renderer(const Building& building, const RayScene& rays, const core::Camera& camera,
                   int num_threads)
    : building_(building),
      rays_(rays),
      light_(building.rectangles, rays, num_threads),
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

const Rectangle& Renderer::rectangle(const MovingThings& moving, int surface) const {
  const int num_at_rest = static_cast<int>(building_.rectangles.size());
  return surface < num_at_rest ? building_.rectangles[static_cast<std::size_t>(surface)]
                               : moving.rectangle(surface - num_at_rest);
}

void Renderer::shade_run(const Eye& eye, MovingThings& moving, const Run& run, View& view) const {
  const int num_at_rest = static_cast<int>(building_.rectangles.size());
  const Rectangle& r = rectangle(moving, run.surface());
  const Eigen::Vector3f normal = r.normal();
  const Eigen::Vector2f eye_m = r.right_up_m(eye.position);
  const auto light_at = [&](const Eigen::Vector2f& right_up_m) -> Colour {
    if (is_emitting(r.material)) return Colour::Constant(r.material.radiance);
    return run.surface() < num_at_rest ? light_.at(run.surface(), right_up_m)
                                       : moving.light_at(run.surface() - num_at_rest, right_up_m);
  };
  auto* const radiance = view.radiance.ptr<cv::Vec3f>(run.y) + run.first_x;
  auto* const depth_m = view.depth_m.ptr<float>(run.y) + run.first_x;
  auto* const incidence = view.incidence.ptr<float>(run.y) + run.first_x;
  for (std::size_t i = 0; i < run.hits.size(); ++i) {
    const Eigen::Vector3f& direction = run.directions[i];
    const float reach = run.hits[i].reach;
    const Eigen::Vector2f right_up_m =
        eye_m + reach * Eigen::Vector2f(r.right.dot(direction), r.up.dot(direction));
    incidence[i] = std::abs(direction.dot(normal)) / direction.norm();
    depth_m[i] = reach;
    const float stretch = std::min(1.0F / std::sqrt(incidence[i]), kMaxStretch);
    const Colour shade =
        reflectance(r, {right_up_m.x(), right_up_m.y(), reach * pixel_rad_ * stretch}) *
        light_at(right_up_m);
    radiance[i] = {shade[0], shade[1], shade[2]};
  }
}

// The radiance of what a ray meets of the building, by the mean colour of its surface.
Colour Renderer::without_texture(const Ray& ray, const Hit& hit) const {
  const Rectangle& r = building_.rectangles[static_cast<std::size_t>(hit.rectangle)];
  const Colour light =
      is_emitting(r.material)
          ? Colour::Constant(r.material.radiance)
          : light_.at(hit.rectangle, r.right_up_m(ray.origin + hit.reach * ray.direction));
  return mean_reflectance(r.material) * light;
}

// The mean of what rays around a mirrored one meet, lamps dimmed to `brightest`. A rough surface
// seen aslant blurs less across the plane of sight and normal than along it. The same rays
// everywhere: nothing sparkles.
Colour Renderer::blurred(const Ray& axis, const Eigen::Vector3f& normal, float half_angle_rad,
                         float brightest) const {
  constexpr float kRaysPerRad = 110.0F;
  constexpr std::size_t kMostRays = 16;
  constexpr float kGoldenAngle_rad = 2.3999632F;
  const auto num_rays =
      std::min(kMostRays, 1 + static_cast<std::size_t>(kRaysPerRad * half_angle_rad));
  const float cosine = normal.dot(axis.direction);
  const Eigen::Vector3f across = axis.direction.cross(normal).stableNormalized();
  const Eigen::Vector3f along = axis.direction.cross(across);
  std::array<Eigen::Vector3f, kMostRays> directions;
  for (std::size_t i = 0; i < num_rays; ++i) {
    const float ratio = (static_cast<float>(i) + 0.5F) / static_cast<float>(num_rays);
    const float out = num_rays == 1 ? 0.0F : half_angle_rad * std::sqrt(ratio);
    const float turn_rad = kGoldenAngle_rad * static_cast<float>(i);
    directions[i] = axis.direction + out * std::cos(turn_rad) * along +
                    out * std::sin(turn_rad) * std::abs(cosine) * across;
  }
  std::array<Hit, kMostRays> hits;
  rays_.first_hits(axis.origin, std::span(directions).first(num_rays),
                   std::span(hits).first(num_rays));
  Colour sum = Colour::Zero();
  for (std::size_t i = 0; i < num_rays; ++i) {
    if (hits[i].rectangle < 0) continue;
    sum += without_texture({axis.origin, directions[i]}, hits[i]).min(brightest);
  }
  return sum / static_cast<float>(num_rays);
}

// What glass, varnish or polish mirrors where a ray meets it (Schlick, An Inexpensive BRDF Model
// for Physically based Rendering, 1994). No surface is quite flat: its normal wavers.
Colour Renderer::mirrored(const Ray& ray, const Hit& hit) const {
  constexpr float kStraightOn = 0.04F;  // of varnish and glass
  constexpr float kWave_m = 0.09F;
  constexpr float kWaver = 0.005F;
  constexpr float kOffSurface_m = 1e-3F;
  // what is not quite smooth leaves of a lamp
  constexpr float kBrightestInGlass = 4.0F;
  constexpr float kBrightestElsewhere = 1.5F;
  const Rectangle& r = building_.rectangles[static_cast<std::size_t>(hit.rectangle)];
  const Eigen::Vector3f point = ray.origin + hit.reach * ray.direction;
  const Eigen::Vector2f wave = r.right_up_m(point) / kWave_m;
  const std::uint32_t seed = r.material.wear_seed;
  const Eigen::Vector3f slope = value_noise(wave.x(), wave.y(), seed) * r.right +
                                value_noise(wave.x(), wave.y(), seed + 1) * r.up;
  const Eigen::Vector3f normal = (r.normal() + kWaver * slope).normalized();
  const Eigen::Vector3f direction = ray.direction.normalized();
  const float towards = direction.dot(normal);
  const float aslant = 1.0F - std::min(std::abs(towards), 1.0F);
  const float share =
      kStraightOn + (1.0F - kStraightOn) * aslant * aslant * aslant * aslant * aslant;
  const Ray back{point + kOffSurface_m * r.normal(), direction - 2.0F * towards * normal};
  const float roughness_rad = r.material.roughness_rad;
  const float brightest = roughness_rad > 0.0F ? kBrightestElsewhere : kBrightestInGlass;
  return std::min(r.material.gloss * share, 1.0F) *
         blurred(back, r.normal(), roughness_rad, brightest);
}

// Adds what the surface mirrors: it moves over the surface as the eye moves. Computed for some
// pixels and interpolated between them.
void Renderer::mirror_in_run(const Eye& eye, const Run& run, View& view) const {
  const Material& material = building_.rectangles[static_cast<std::size_t>(run.surface())].material;
  const std::size_t step_px = material.roughness_rad > 0.0F ? 8 : 4;
  const auto mirrored_at = [&](std::size_t i) {
    return mirrored({eye.position, run.directions[i]}, run.hits[i]);
  };
  auto* const radiance = view.radiance.ptr<cv::Vec3f>(run.y) + run.first_x;
  const std::size_t last = run.hits.size() - 1;
  Colour here = mirrored_at(0);
  for (std::size_t first = 0; first <= last; first += step_px) {
    const std::size_t next = std::min(first + step_px, last);
    const Colour there = mirrored_at(next);
    for (std::size_t i = first; i < first + step_px && i <= last; ++i) {
      const float ratio = static_cast<float>(i - first) / static_cast<float>(step_px);
      const Colour between = here + ratio * (there - here);
      radiance[i] += cv::Vec3f(between[0], between[1], between[2]);
    }
    here = there;
  }
}

// What things that move keep from the surfaces close to them changes slowly over the picture: it is
// computed for some pixels and interpolated.
void Renderer::darken_run(const Eye& eye, const MovingThings& moving, const Run& run,
                          View& view) const {
  constexpr std::size_t kStep = 4;
  const Eigen::Vector3f normal = rectangle(moving, run.surface()).normal();
  auto* const radiance = view.radiance.ptr<cv::Vec3f>(run.y) + run.first_x;
  const std::size_t last = run.hits.size() - 1;
  const auto share_at = [&](std::size_t i) {
    return moving.share_left({eye.position + run.hits[i].reach * run.directions[i], normal});
  };
  float share = share_at(0);
  for (std::size_t first = 0; first <= last; first += kStep) {
    const std::size_t next = std::min(first + kStep, last);
    const float next_share = share_at(next);
    for (std::size_t i = first; i < first + kStep && i <= last; ++i) {
      const float ratio = static_cast<float>(i - first) / static_cast<float>(kStep);
      radiance[i] *= share + ratio * (next_share - share);
    }
    share = next_share;
  }
}

void Renderer::render_row(const Eye& eye, MovingThings& moving, int y, View& view) const {
  const auto num_pixels = static_cast<std::size_t>(width_px_);
  const Eigen::Vector3f* const in_camera =
      &rays_in_camera_[static_cast<std::size_t>(y * (width_px_ + 1))];
  std::vector<Eigen::Vector3f> directions(num_pixels);
  for (std::size_t x = 0; x < num_pixels; ++x) {
    directions[x] = eye.world_from_camera * in_camera[x];
  }
  std::vector<Hit> hits(num_pixels);
  rays_.first_hits(eye.position, directions, hits);
  const int num_at_rest = static_cast<int>(building_.rectangles.size());
  moving.meet(eye.position, directions, num_at_rest, hits);
  int* const surface = view.surface.ptr<int>(y);
  for (std::size_t first = 0, end = 0; first < num_pixels; first = end) {
    const int seen = hits[first].rectangle;
    for (end = first; end < num_pixels && hits[end].rectangle == seen; ++end) surface[end] = seen;
    if (seen < 0) continue;
    const Run run{.y = y,
                  .first_x = static_cast<int>(first),
                  .directions = std::span(directions).subspan(first, end - first),
                  .hits = std::span(hits).subspan(first, end - first)};
    shade_run(eye, moving, run, view);
    if (seen < num_at_rest &&
        building_.rectangles[static_cast<std::size_t>(seen)].material.gloss > 0.0F) {
      mirror_in_run(eye, run, view);
    }
    if (!moving.is_empty() && seen < num_at_rest) darken_run(eye, moving, run, view);
  }
}

// The colour of a pixel that several surfaces share: each gives that of the nearest pixel around
// that shows it.
cv::Vec3f Renderer::smooth_pixel(const Eye& eye, const MovingThings& moving, const View& view,
                                 const cv::Point& pixel) const {
  // a turned square, so that upright and level edges take five steps rather than three
  constexpr float kOffsets_px[4][2] = {
      {0.375F, 0.125F}, {-0.125F, 0.375F}, {-0.375F, -0.125F}, {0.125F, -0.375F}};
  struct Neighbour {
    int surface = -1;
    cv::Point at;
  };
  std::array<Neighbour, 5> neighbours;  // of different surfaces, this pixel's first
  std::size_t num_neighbours = 0;
  for (const auto& step :
       {cv::Point(0, 0), cv::Point(1, 0), cv::Point(-1, 0), cv::Point(0, 1), cv::Point(0, -1)}) {
    const int surface = view.surface.at<int>(pixel + step);
    const auto end = neighbours.begin() + static_cast<std::ptrdiff_t>(num_neighbours);
    const bool is_new = std::none_of(neighbours.begin(), end,
                                     [&](const Neighbour& n) { return n.surface == surface; });
    if (surface >= 0 && is_new) neighbours[num_neighbours++] = {surface, pixel + step};
  }
  cv::Vec3f sum(0.0F, 0.0F, 0.0F);
  for (const auto& offset_px : kOffsets_px) {
    const Ray through{eye.position,
                      eye.world_from_camera * ray(static_cast<float>(pixel.x) + offset_px[0],
                                                  static_cast<float>(pixel.y) + offset_px[1])};
    cv::Point nearest = pixel;
    float nearest_reach = std::numeric_limits<float>::infinity();
    for (std::size_t i = 0; i < num_neighbours; ++i) {
      const auto reach = reach_of(through, rectangle(moving, neighbours[i].surface));
      if (!reach || *reach >= nearest_reach) continue;
      nearest = neighbours[i].at;
      nearest_reach = *reach;
    }
    const cv::Vec3f& colour = view.radiance.at<cv::Vec3f>(nearest);
    for (int i = 0; i < 3; ++i) sum[i] += std::min(colour[i], kBrightest);
  }
  return 0.25F * sum;
}

void Renderer::smooth_edges(const Eye& eye, const MovingThings& moving, View& view) const {
  std::vector<std::pair<cv::Point, cv::Vec3f>> smoothed;
  for (int y = 1; y + 1 < height_px_; ++y) {
    for (int x = 1; x + 1 < width_px_; ++x) {
      const cv::Point pixel(x, y);
      if (!is_edge(view.surface, pixel)) continue;
      smoothed.emplace_back(pixel, smooth_pixel(eye, moving, view, pixel));
    }
  }
  for (const auto& [pixel, colour] : smoothed) view.radiance.at<cv::Vec3f>(pixel) = colour;
}

View Renderer::render(const core::Rigid3& world_from_camera,
                      const std::vector<Rectangle>& moving_rectangles) const {
  const Eye eye{world_from_camera.rotation.toRotationMatrix().cast<float>(),
                world_from_camera.translation.cast<float>()};
  MovingThings moving(moving_rectangles, light_);
  View view{.radiance = cv::Mat::zeros(height_px_, width_px_, CV_32FC3),
            .depth_m = cv::Mat::zeros(height_px_, width_px_, CV_32F),
            .incidence = cv::Mat::zeros(height_px_, width_px_, CV_32F),
            .surface = cv::Mat(height_px_, width_px_, CV_32S)};
  for (int y = 0; y < height_px_; ++y) render_row(eye, moving, y, view);
  smooth_edges(eye, moving, view);
  return view;
}

float Renderer::mean_radiance(const core::Rigid3& world_from_camera) const {
  constexpr int kColumns = 16;
  constexpr int kRows = 12;
  const Eigen::Matrix3f rotation = world_from_camera.rotation.toRotationMatrix().cast<float>();
  const Eigen::Vector3f position = world_from_camera.translation.cast<float>();
  std::vector<Eigen::Vector3f> directions;
  for (int row = 0; row < kRows; ++row) {
    for (int column = 0; column < kColumns; ++column) {
      directions.emplace_back(rotation *
                              ray((static_cast<float>(column) + 0.5F) / kColumns * width_px_,
                                  (static_cast<float>(row) + 0.5F) / kRows * height_px_));
    }
  }
  std::vector<Hit> hits(directions.size());
  rays_.first_hits(position, directions, hits);
  Colour sum = Colour::Zero();
  for (std::size_t i = 0; i < hits.size(); ++i) {
    if (hits[i].rectangle < 0) continue;
    sum += without_texture({position, directions[i]}, hits[i]).min(kBrightest);
  }
  return sum.mean() / static_cast<float>(hits.size());
}

}  // namespace samewhere::twin
