#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/geometry/camera.hpp>
#include <samewhere/run/export_model.hpp>

namespace samewhere::run {
namespace {

// From pixels of the pictures that SLAM saw to those of the exported ones. The outer corner of the
// upper left pixel is (-0.5, -0.5) in both.
struct PixelScale {
  Eigen::Vector2d factors = Eigen::Vector2d::Ones();

  Eigen::Vector2d apply(const Eigen::Vector2d& pixel) const {
    return ((pixel.array() + 0.5) * factors.array() - 0.5).matrix();
  }
};

PixelScale scale_to(const features::View& view, const cv::Size& size_px) {
  const Eigen::Vector2d factors(static_cast<double>(size_px.width) / view.image_size_px.width,
                                static_cast<double>(size_px.height) / view.image_size_px.height);
  constexpr double kMostApart = 0.02;  // what rounding to whole pixels does to a small picture
  if (!(std::abs(factors.x() / factors.y() - 1.0) < kMostApart)) {
    throw core::InputError(fmt::format(
        "the source's pictures have {} x {} pixels, those of the run had {} x {}: the source has "
        "changed since the run",
        size_px.width, size_px.height, view.image_size_px.width, view.image_size_px.height));
  }
  return {factors};
}

bool is_inside(const Eigen::Vector2d& pixel, const cv::Size& size_px) {
  return pixel.x() >= -0.5 && pixel.y() >= -0.5 && pixel.x() <= size_px.width - 0.5 &&
         pixel.y() <= size_px.height - 0.5;
}

// Makes a model of a map, point by point.
class ModelMaker {
 public:
  ModelMaker(const scene::MapVersion& map, const std::vector<const scene::Keyframe*>& keyframes,
             const ExportedPictures& pictures)
      : map_(map),
        keyframes_(keyframes),
        pictures_(pictures),
        scale_(scale_to(keyframes.front()->view, pictures.size_px)) {
    model_.camera = camera_of_pictures(keyframes.front()->view, pictures);
    for (const scene::Keyframe* keyframe : keyframes) {
      positions_[keyframe->id] = model_.views.size();
      model_.views.push_back({keyframe->view.frame,
                              keyframe->view.stamp_s,
                              keyframe->world_from_body * keyframe->view.rig->body_from_camera[0],
                              {}});
      camera_from_world_.push_back(inverse(model_.views.back().world_from_camera));
    }
  }

  void add(const scene::Landmark& landmark) {
    ExportedPoint point{position_in_world(map_, landmark), landmark.rgb, 0.0, {}};
    std::vector<std::pair<std::size_t, Eigen::Vector2d>> seen;  // view, pixel
    for (const scene::Observation& observation : landmark.observations) {
      const auto view = positions_.find(observation.keyframe);
      if (view == positions_.end()) continue;
      const Eigen::Vector2d pixel = pixel_of(view->second, observation.slot);
      const auto error_px = error_of(point.in_world, view->second, pixel);
      if (!error_px) continue;
      point.error_px += *error_px;
      seen.emplace_back(view->second, pixel);
    }
    constexpr std::size_t kMinObservations = 2;
    if (seen.size() < kMinObservations) return;
    point.error_px /= static_cast<double>(seen.size());
    for (const auto& [view, pixel] : seen) {
      point.observations.push_back({view, model_.views[view].features.size()});
      model_.views[view].features.push_back({pixel, model_.points.size()});
    }
    model_.points.push_back(std::move(point));
  }

  ExportedModel take() { return std::move(model_); }

 private:
  Eigen::Vector2d pixel_of(std::size_t view, int slot) const {
    const features::Features& features = *keyframes_[view]->view.features;
    const auto& pixels = pictures_.is_undistorted ? features.undistorted_px : features.raw_px;
    return scale_.apply(pixels[static_cast<std::size_t>(slot)].cast<double>());
  }

  // Nothing where the exported picture does not show it.
  std::optional<double> error_of(const Eigen::Vector3d& in_world, std::size_t view,
                                 const Eigen::Vector2d& pixel) const {
    const auto predicted = geometry::project(model_.camera, camera_from_world_[view] * in_world);
    if (!predicted || !is_inside(pixel, pictures_.size_px)) return std::nullopt;
    return (*predicted - pixel).norm();
  }

  const scene::MapVersion& map_;
  const std::vector<const scene::Keyframe*>& keyframes_;
  ExportedPictures pictures_;
  PixelScale scale_;
  ExportedModel model_;
  std::map<core::KeyframeId, std::size_t> positions_;  // in model_.views
  std::vector<core::Rigid3> camera_from_world_;        // by view
};

}  // namespace

std::vector<const scene::Keyframe*> keyframes_of_session(const scene::MapVersion& map,
                                                         int session) {
  std::vector<const scene::Keyframe*> keyframes;
  for (std::size_t i = 0; i < map.keyframes.size(); ++i) {
    const scene::Keyframe& keyframe = map.keyframes[i];
    if (is_live(keyframe) && keyframe.view.frame.session() == session)
      keyframes.push_back(&keyframe);
  }
  if (keyframes.empty())
    throw core::InputError(fmt::format("the map has no keyframe of session {}", session));
  std::sort(keyframes.begin(), keyframes.end(),
            [](const auto* a, const auto* b) { return a->view.frame < b->view.frame; });
  return keyframes;
}

core::PinholeRadtan camera_of_pictures(const features::View& view,
                                       const ExportedPictures& pictures) {
  const PixelScale scale = scale_to(view, pictures.size_px);
  core::PinholeRadtan camera = geometry::pinhole(view.rig->cameras.front());
  camera.width_px = pictures.size_px.width;
  camera.height_px = pictures.size_px.height;
  camera.fx_px *= scale.factors.x();
  camera.fy_px *= scale.factors.y();
  const Eigen::Vector2d centre_px = scale.apply({camera.cx_px, camera.cy_px});
  camera.cx_px = centre_px.x();
  camera.cy_px = centre_px.y();
  if (!pictures.is_undistorted) return camera;
  return {.width_px = camera.width_px,
          .height_px = camera.height_px,
          .fx_px = camera.fx_px,
          .fy_px = camera.fy_px,
          .cx_px = camera.cx_px,
          .cy_px = camera.cy_px};
}

ExportedModel model_of(const scene::MapVersion& map, int session,
                       const ExportedPictures& pictures) {
  const std::vector<const scene::Keyframe*> keyframes = keyframes_of_session(map, session);
  ModelMaker maker(map, keyframes, pictures);
  for (std::size_t i = 0; i < map.landmarks.size(); ++i) {
    if (is_live(map.landmarks[i])) maker.add(map.landmarks[i]);
  }
  return maker.take();
}

bool has_distortion(const core::PinholeRadtan& camera) {
  return camera.k1 != 0.0 || camera.k2 != 0.0 || camera.p1 != 0.0 || camera.p2 != 0.0 ||
         camera.k3 != 0.0;
}

std::size_t num_observations(const ExportedModel& model) {
  std::size_t count = 0;
  for (const ExportedPoint& point : model.points) count += point.observations.size();
  return count;
}

double mean_error_px(const ExportedModel& model) {
  double sum_px = 0.0;
  for (const ExportedPoint& point : model.points) sum_px += point.error_px;
  return model.points.empty() ? 0.0 : sum_px / static_cast<double>(model.points.size());
}

}  // namespace samewhere::run
