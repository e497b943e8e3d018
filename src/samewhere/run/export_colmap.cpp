#include <cstdint>
#include <iterator>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <samewhere/report/little_endian.hpp>
#include <samewhere/run/export_colmap.hpp>
#include <samewhere/run/export_pictures.hpp>

namespace samewhere::run {
namespace {

using report::append_little_endian;

constexpr double kColmapHalfPixel = 0.5;
constexpr std::uint32_t kColmapCamera = 1;

struct ColmapCamera {
  const char* name = "PINHOLE";
  std::int32_t id = 1;  // of the model, in binary files
  std::vector<double> parameters;
};

ColmapCamera colmap_camera(const core::PinholeRadtan& c) {
  ColmapCamera camera{
      "PINHOLE", 1, {c.fx_px, c.fy_px, c.cx_px + kColmapHalfPixel, c.cy_px + kColmapHalfPixel}};
  if (!has_distortion(c)) return camera;
  const bool has_k3 = c.k3 != 0.0;
  camera.name = has_k3 ? "FULL_OPENCV" : "OPENCV";
  camera.id = has_k3 ? 6 : 4;
  for (const double parameter : {c.k1, c.k2, c.p1, c.p2}) camera.parameters.push_back(parameter);
  if (has_k3) {
    for (const double parameter : {c.k3, 0.0, 0.0, 0.0}) camera.parameters.push_back(parameter);
  }
  return camera;
}

// qw qx qy qz tx ty tz of camera_from_world, qw not negative.
std::vector<double> colmap_pose(const ExportedView& view) {
  const core::Rigid3 camera_from_world = inverse(view.world_from_camera);
  Eigen::Quaterniond q = camera_from_world.rotation.normalized();
  if (q.w() < 0.0) q.coeffs() *= -1.0;
  const Eigen::Vector3d& t = camera_from_world.translation;
  return {q.w(), q.x(), q.y(), q.z(), t.x(), t.y(), t.z()};
}

std::string colmap_cameras_text(const core::PinholeRadtan& c) {
  const ColmapCamera camera = colmap_camera(c);
  return fmt::format("# CAMERA_ID, MODEL, WIDTH, HEIGHT, PARAMS[]\n{} {} {} {} {}\n", kColmapCamera,
                     camera.name, c.width_px, c.height_px, fmt::join(camera.parameters, " "));
}

std::string colmap_images_text(const ExportedModel& model) {
  std::string text =
      "# IMAGE_ID, QW, QX, QY, QZ, TX, TY, TZ, CAMERA_ID, NAME\n# POINTS2D[] as X, Y, POINT3D_ID\n";
  for (std::size_t i = 0; i < model.views.size(); ++i) {
    const ExportedView& view = model.views[i];
    fmt::format_to(std::back_inserter(text), "{} {} {} {}\n", i + 1,
                   fmt::join(colmap_pose(view), " "), kColmapCamera, picture_name(view.frame));
    const char* blank = "";
    for (const ExportedFeature& feature : view.features) {
      fmt::format_to(std::back_inserter(text), "{}{:.4f} {:.4f} {}", blank,
                     feature.pixel.x() + kColmapHalfPixel, feature.pixel.y() + kColmapHalfPixel,
                     feature.point + 1);
      blank = " ";
    }
    text += '\n';
  }
  return text;
}

std::string colmap_points_text(const ExportedModel& model) {
  std::string text = "# POINT3D_ID, X, Y, Z, R, G, B, ERROR, TRACK[] as IMAGE_ID, POINT2D_IDX\n";
  for (std::size_t i = 0; i < model.points.size(); ++i) {
    const ExportedPoint& point = model.points[i];
    fmt::format_to(std::back_inserter(text), "{} {} {} {} {} {} {} {:.6f}", i + 1,
                   point.in_world.x(), point.in_world.y(), point.in_world.z(), point.rgb[0],
                   point.rgb[1], point.rgb[2], point.error_px);
    for (const ExportedObservation& observation : point.observations)
      fmt::format_to(std::back_inserter(text), " {} {}", observation.view + 1, observation.feature);
    text += '\n';
  }
  return text;
}

std::string colmap_cameras_binary(const core::PinholeRadtan& c) {
  const ColmapCamera camera = colmap_camera(c);
  std::string bytes;
  append_little_endian(bytes, std::uint64_t{1});
  append_little_endian(bytes, kColmapCamera);
  append_little_endian(bytes, camera.id);
  append_little_endian(bytes, static_cast<std::uint64_t>(c.width_px));
  append_little_endian(bytes, static_cast<std::uint64_t>(c.height_px));
  for (const double parameter : camera.parameters) append_little_endian(bytes, parameter);
  return bytes;
}

std::string colmap_images_binary(const ExportedModel& model) {
  std::string bytes;
  append_little_endian(bytes, std::uint64_t{model.views.size()});
  for (std::size_t i = 0; i < model.views.size(); ++i) {
    const ExportedView& view = model.views[i];
    append_little_endian(bytes, static_cast<std::uint32_t>(i + 1));
    for (const double value : colmap_pose(view)) append_little_endian(bytes, value);
    append_little_endian(bytes, kColmapCamera);
    bytes += picture_name(view.frame);
    bytes += '\0';
    append_little_endian(bytes, std::uint64_t{view.features.size()});
    for (const ExportedFeature& feature : view.features) {
      append_little_endian(bytes, feature.pixel.x() + kColmapHalfPixel);
      append_little_endian(bytes, feature.pixel.y() + kColmapHalfPixel);
      append_little_endian(bytes, std::uint64_t{feature.point + 1});
    }
  }
  return bytes;
}

std::string colmap_points_binary(const ExportedModel& model) {
  std::string bytes;
  append_little_endian(bytes, std::uint64_t{model.points.size()});
  for (std::size_t i = 0; i < model.points.size(); ++i) {
    const ExportedPoint& point = model.points[i];
    append_little_endian(bytes, std::uint64_t{i + 1});
    for (const double coordinate : point.in_world) append_little_endian(bytes, coordinate);
    for (const std::uint8_t channel : point.rgb) append_little_endian(bytes, channel);
    append_little_endian(bytes, point.error_px);
    append_little_endian(bytes, std::uint64_t{point.observations.size()});
    for (const ExportedObservation& observation : point.observations) {
      append_little_endian(bytes, static_cast<std::uint32_t>(observation.view + 1));
      append_little_endian(bytes, static_cast<std::uint32_t>(observation.feature));
    }
  }
  return bytes;
}

}  // namespace

const char* colmap_camera_model(const core::PinholeRadtan& camera) {
  return colmap_camera(camera).name;
}

ColmapFiles colmap_text(const ExportedModel& model) {
  return {colmap_cameras_text(model.camera), colmap_images_text(model), colmap_points_text(model)};
}

ColmapFiles colmap_binary(const ExportedModel& model) {
  return {colmap_cameras_binary(model.camera), colmap_images_binary(model),
          colmap_points_binary(model)};
}

}  // namespace samewhere::run
