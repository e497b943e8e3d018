#include <cmath>
#include <numbers>
#include <vector>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/text_file.hpp>
#include <samewhere/geometry/camera.hpp>
#include <samewhere/input/camera_file.hpp>

namespace samewhere::input {
namespace {

void check_row(const core::TextLine& line, bool is_right, const char* expected) {
  if (is_right) return;
  throw core::InputError(
      fmt::format("{}: found {}, expected {}", line.place, fmt::join(line.words, " "), expected));
}

void read_distortion(const core::TextLine& line, core::PinholeRadtan& camera) {
  const std::vector<double> k =
      core::finite_numbers(line, 5, "k1 k2 p1 p2 k3; or 2, width height, px");
  camera.k1 = k[0];
  camera.k2 = k[1];
  camera.p1 = k[2];
  camera.p2 = k[3];
  camera.k3 = k[4];
}

bool is_length_px(double number) {
  constexpr double kMost_px = 1e6;
  return number >= 1.0 && number <= kMost_px && number == std::floor(number);
}

void read_size(const core::TextLine& line, core::PinholeRadtan& camera) {
  const std::vector<double> size = core::finite_numbers(line, 2, "width height, px");
  check_row(line, is_length_px(size[0]) && is_length_px(size[1]),
            "width height of the pictures, whole pixels");
  camera.width_px = static_cast<int>(size[0]);
  camera.height_px = static_cast<int>(size[1]);
}

void warn_of_field_of_view(const std::filesystem::path& path, const core::PinholeRadtan& camera) {
  const double view_rad = geometry::horizontal_field_of_view_rad(camera);
  const bool is_usual =
      view_rad >= geometry::kMinFieldOfView_rad && view_rad <= geometry::kMaxFieldOfView_rad;
  if (is_usual) return;
  constexpr double kDegrees_per_rad = 180.0 / std::numbers::pi;
  spdlog::warn(
      "{}: fx {} px on pictures {} px wide is a horizontal field of view of {:.1f} degrees, "
      "expected {:.0f} to {:.0f}; does the calibration belong to them?",
      path.string(), camera.fx_px, camera.width_px, view_rad * kDegrees_per_rad,
      geometry::kMinFieldOfView_rad * kDegrees_per_rad,
      geometry::kMaxFieldOfView_rad * kDegrees_per_rad);
}

}  // namespace

core::PinholeRadtan read_camera_file(const std::filesystem::path& path) {
  const std::vector<core::TextLine> lines = core::read_text_lines(path);
  if (lines.size() < 3 || lines.size() > 5) {
    throw core::InputError(fmt::format(
        "{}: found {} rows, expected the 3 of the camera matrix and then, if wanted, k1 k2 p1 p2 "
        "k3 and width height",
        path.string(), lines.size()));
  }
  const std::vector<double> x = core::finite_numbers(lines[0], 3, "fx 0 cx");
  const std::vector<double> y = core::finite_numbers(lines[1], 3, "0 fy cy");
  const std::vector<double> z = core::finite_numbers(lines[2], 3, "0 0 1");
  check_row(lines[0], x[0] > 0.0 && x[1] == 0.0, "fx 0 cx with fx > 0");
  check_row(lines[1], y[0] == 0.0 && y[1] > 0.0, "0 fy cy with fy > 0");
  check_row(lines[2], z[0] == 0.0 && z[1] == 0.0 && z[2] == 1.0, "0 0 1");
  core::PinholeRadtan camera{.fx_px = x[0], .fy_px = y[1], .cx_px = x[2], .cy_px = y[2]};
  // the last row may be the size; a row before that is the distortion
  const bool ends_with_size =
      lines.size() == 5 || (lines.size() == 4 && lines[3].words.size() == 2);
  if (ends_with_size) read_size(lines.back(), camera);
  if (lines.size() == 5 || (lines.size() == 4 && !ends_with_size)) {
    read_distortion(lines[3], camera);
  }
  return camera;
}

core::PinholeRadtan read_camera_file_for(const std::filesystem::path& path, const cv::Size& size_px,
                                         const std::filesystem::path& picture) {
  core::PinholeRadtan camera = read_camera_file(path);
  const cv::Size told_px(camera.width_px, camera.height_px);
  if (!told_px.empty() && told_px != size_px) {
    throw core::InputError(fmt::format(
        "{}: wrong calibration: it is for pictures of {} x {} pixels, {} is {} x {}", path.string(),
        told_px.width, told_px.height, picture.string(), size_px.width, size_px.height));
  }
  camera.width_px = size_px.width;
  camera.height_px = size_px.height;
  if (!is_centre_inside(camera)) {
    throw core::InputError(fmt::format(
        "{}: wrong calibration: the centre ({}, {}) lies outside the image, {} is {} x {} pixels",
        path.string(), camera.cx_px, camera.cy_px, picture.string(), size_px.width,
        size_px.height));
  }
  warn_of_field_of_view(path, camera);
  return camera;
}

std::string camera_file_text(const core::PinholeRadtan& camera) {
  std::string text = fmt::format("{} 0 {}\n0 {} {}\n0 0 1\n{} {} {} {} {}\n", camera.fx_px,
                                 camera.cx_px, camera.fy_px, camera.cy_px, camera.k1, camera.k2,
                                 camera.p1, camera.p2, camera.k3);
  if (camera.width_px > 0) {
    text += fmt::format("# width height, px\n{} {}\n", camera.width_px, camera.height_px);
  }
  return text;
}

bool is_centre_inside(const core::PinholeRadtan& camera) {
  return camera.cx_px >= 0.0 && camera.cx_px <= camera.width_px - 1.0 && camera.cy_px >= 0.0 &&
         camera.cy_px <= camera.height_px - 1.0;
}

}  // namespace samewhere::input
