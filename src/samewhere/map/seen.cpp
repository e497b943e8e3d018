#include <algorithm>
#include <cmath>

#include <samewhere/features/stereo.hpp>
#include <samewhere/geometry/camera.hpp>
#include <samewhere/map/seen.hpp>

namespace samewhere::map {
namespace {

constexpr double kMinCosOfView = 0.5;

// A level more or less than the pyramid has may still match.
bool has_level(const scene::Landmark& landmark, double range_m, const features::Config& config) {
  const double level =
      landmark.octave + std::log(landmark.range_m / range_m) / std::log(config.scale_factor);
  return level > -1.5 && level < config.num_levels + 0.5;
}

}  // namespace

optimize::SeenAt seen_at(const features::View& view, int slot, const features::Config& config) {
  const auto i = static_cast<std::size_t>(slot);
  const features::Features& features = *view.features;
  return {features.undistorted_px[i].cast<double>(), features.right_x_px[i],
          std::pow(config.scale_factor, features.octave[i])};
}

core::Rigid3 camera_from_world(const scene::MapVersion& map, const scene::Keyframe& keyframe) {
  return inverse(world_from_body(map, keyframe.id) * keyframe.view.rig->body_from_camera[0]);
}

optimize::Reprojection reproject(const features::View& view, int slot,
                                 const Eigen::Vector3d& point_in_camera,
                                 const features::Config& config) {
  return optimize::reproject(geometry::pinhole(view.rig->cameras[0]),
                             features::baseline_m(*view.rig, config), point_in_camera,
                             seen_at(view, slot, config));
}

std::optional<features::ProjectedPoint> expected_at(const scene::MapVersion& map,
                                                    const scene::Keyframe& keyframe,
                                                    const scene::Landmark& landmark,
                                                    const features::Config& config) {
  const core::Rigid3 world_from_anchor = world_from_body(map, landmark.anchor);
  const core::Rigid3 from_anchor = camera_from_world(map, keyframe) * world_from_anchor;
  const Eigen::Vector3d in_camera = from_anchor * landmark.position_in_anchor;
  const auto pixel = geometry::project_undistorted(keyframe.view.rig->cameras[0], in_camera);
  const cv::Size& size_px = keyframe.view.image_size_px;
  if (!pixel || pixel->x() < 0.0 || pixel->y() < 0.0 || pixel->x() > size_px.width - 1.0 ||
      pixel->y() > size_px.height - 1.0) {
    return std::nullopt;
  }
  const double range_m = in_camera.norm();
  const Eigen::Vector3d normal = from_anchor.rotation * landmark.normal_in_anchor;
  if (normal.dot(-in_camera) < kMinCosOfView * range_m) return std::nullopt;
  if (!has_level(landmark, range_m, config)) return std::nullopt;
  const int octave = features::octave_at(landmark.octave, landmark.range_m, range_m, config);
  return features::ProjectedPoint{0, *pixel, octave};
}

bool is_seen_by(const scene::Landmark& landmark, core::KeyframeId keyframe) {
  return std::any_of(landmark.observations.begin(), landmark.observations.end(),
                     [&](const scene::Observation& o) { return o.keyframe == keyframe; });
}

}  // namespace samewhere::map
