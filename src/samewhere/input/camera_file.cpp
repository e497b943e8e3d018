#include <vector>

#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/text_file.hpp>
#include <samewhere/input/camera_file.hpp>

namespace samewhere::input {
namespace {

void check_row(const core::TextLine& line, bool is_right, const char* expected) {
  if (is_right) return;
  throw core::InputError(
      fmt::format("{}: found {}, expected {}", line.place, fmt::join(line.words, " "), expected));
}

}  // namespace

core::PinholeRadtan read_camera_file(const std::filesystem::path& path) {
  const std::vector<core::TextLine> lines = core::read_text_lines(path);
  if (lines.size() != 3 && lines.size() != 4) {
    throw core::InputError(fmt::format(
        "{}: found {} rows, expected the 3 of the camera matrix and then, if wanted, k1 k2 p1 p2 "
        "k3",
        path.string(), lines.size()));
  }
  const std::vector<double> x = core::finite_numbers(lines[0], 3, "fx 0 cx");
  const std::vector<double> y = core::finite_numbers(lines[1], 3, "0 fy cy");
  const std::vector<double> z = core::finite_numbers(lines[2], 3, "0 0 1");
  check_row(lines[0], x[0] > 0.0 && x[1] == 0.0, "fx 0 cx with fx > 0");
  check_row(lines[1], y[0] == 0.0 && y[1] > 0.0, "0 fy cy with fy > 0");
  check_row(lines[2], z[0] == 0.0 && z[1] == 0.0 && z[2] == 1.0, "0 0 1");
  core::PinholeRadtan camera{.fx_px = x[0], .fy_px = y[1], .cx_px = x[2], .cy_px = y[2]};
  if (lines.size() == 3) return camera;
  const std::vector<double> k = core::finite_numbers(lines[3], 5, "k1 k2 p1 p2 k3");
  camera.k1 = k[0];
  camera.k2 = k[1];
  camera.p1 = k[2];
  camera.p2 = k[3];
  camera.k3 = k[4];
  return camera;
}

core::PinholeRadtan read_camera_file_for(const std::filesystem::path& path, const cv::Size& size_px,
                                         const std::filesystem::path& picture) {
  core::PinholeRadtan camera = read_camera_file(path);
  camera.width_px = size_px.width;
  camera.height_px = size_px.height;
  if (is_centre_inside(camera)) return camera;
  throw core::InputError(fmt::format(
      "{}: wrong calibration: the centre ({}, {}) lies outside the image, {} is {} x {} pixels",
      path.string(), camera.cx_px, camera.cy_px, picture.string(), size_px.width, size_px.height));
}

std::string camera_file_text(const core::PinholeRadtan& camera) {
  return fmt::format("{} 0 {}\n0 {} {}\n0 0 1\n{} {} {} {} {}\n", camera.fx_px, camera.cx_px,
                     camera.fy_px, camera.cy_px, camera.k1, camera.k2, camera.p1, camera.p2,
                     camera.k3);
}

bool is_centre_inside(const core::PinholeRadtan& camera) {
  return camera.cx_px >= 0.0 && camera.cx_px <= camera.width_px - 1.0 && camera.cy_px >= 0.0 &&
         camera.cy_px <= camera.height_px - 1.0;
}

}  // namespace samewhere::input
