#include <cctype>
#include <cmath>
#include <numbers>
#include <sstream>
#include <string_view>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/text_file.hpp>
#include <samewhere/geometry/camera.hpp>
#include <samewhere/geometry/camera_check.hpp>
#include <samewhere/input/calibration_files.hpp>
#include <samewhere/input/camera_file.hpp>

namespace samewhere::input {
namespace {

using core::InputError;

enum class Format { kRows, kYaml, kXml, kColmap, kUnknown };

bool is_letter(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; }

// `key: value`, or `"key": value`.
bool has_key(std::string_view line) {
  const std::size_t colon = line.find(':');
  return colon != std::string_view::npos && (is_letter(line.front()) || line.front() == '"');
}

// Numbers, or a name that a row of ours begins with; or a camera of COLMAP: number, model, ...
Format format_of_words(const std::string& line) {
  std::istringstream words(line);
  std::string one;
  std::string two;
  words >> one >> two;
  if (!two.empty() && is_letter(two.front()) && two != "nan" && two != "inf")
    return Format::kColmap;
  const bool is_named = one == "fisheye" || one == "depth_factor";
  return is_letter(one.front()) && !is_named ? Format::kUnknown : Format::kRows;
}

Format format_of_line(const std::string& line) {
  if (line.front() == '<') return Format::kXml;
  if (line.front() == '{' || line.starts_with("---") || has_key(line)) return Format::kYaml;
  return format_of_words(line);
}

// By the first line that says something.
Format format_of(const std::string& text) {
  if (text.find('\0') != std::string::npos) return Format::kUnknown;
  if (text.starts_with("%YAML")) return Format::kYaml;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t first = line.find_first_not_of(" \t\r");
    if (first != std::string::npos && line[first] != '#') return format_of_line(line.substr(first));
  }
  return Format::kRows;
}

Calibration read_calibration(const std::filesystem::path& path) {
  const std::string text = core::read_text(path, core::kCalibrationLimit);
  switch (format_of(text)) {
    case Format::kRows:
      return read_rows_calibration(path);
    case Format::kYaml:
      return read_yaml_calibration(YamlKeys(path, text));
    case Format::kXml:
      return read_xml_calibration(path, text);
    case Format::kColmap:
      return read_colmap_calibration(path);
    case Format::kUnknown:
      break;
  }
  throw InputError(
      fmt::format("{}: is no camera file, expected {}", path.string(), kCalibrationFormats));
}

void warn_of_field_of_view(const std::filesystem::path& path, const core::Camera& camera) {
  const double view_rad = geometry::horizontal_field_of_view_rad(camera);
  const bool is_fisheye = std::holds_alternative<core::KannalaBrandt>(camera);
  const bool is_usual = view_rad >= geometry::kMinFieldOfView_rad &&
                        (is_fisheye || view_rad <= geometry::kMaxFieldOfView_rad);
  if (is_usual) return;
  constexpr double kDegrees_per_rad = 180.0 / std::numbers::pi;
  spdlog::warn(
      "{}: fx {} px on pictures {} px wide is a horizontal field of view of {:.1f} degrees, "
      "expected {:.0f} to {:.0f}; does the calibration belong to them?",
      path.string(), geometry::focal_lengths_px(camera).x(), geometry::picture_size_px(camera).x(),
      view_rad * kDegrees_per_rad, geometry::kMinFieldOfView_rad * kDegrees_per_rad,
      geometry::kMaxFieldOfView_rad * kDegrees_per_rad);
}

cv::Size size_of(const core::Camera& camera) {
  const Eigen::Vector2i size_px = geometry::picture_size_px(camera);
  return {size_px.x(), size_px.y()};
}

// As OpenCV writes it: 5 values, and 8 of the rational model.
std::string distortion_text(const core::PinholeRadtan& c) {
  const std::string five = fmt::format("{} {} {} {} {}", c.k1, c.k2, c.p1, c.p2, c.k3);
  if (geometry::is_brown(c)) return five;
  return fmt::format("{} {} {} {}", five, c.k4, c.k5, c.k6);
}

std::string distortion_text(const core::KannalaBrandt& c) {
  return fmt::format("fisheye {} {} {} {}", c.k1, c.k2, c.k3, c.k4);
}

}  // namespace

CameraFile read_camera_file(const std::filesystem::path& path) {
  const Calibration calibration = read_calibration(path);
  constexpr double kMostUnits = 1e6;
  if (const auto& units = calibration.depth_units_per_m; units) {
    if (!(*units >= 1.0 && *units <= kMostUnits)) {
      throw InputError(fmt::format("{}: found {} depth units per metre, expected 1 to {}",
                                   path.string(), *units, kMostUnits));
    }
  }
  return {camera_of(calibration), calibration.depth_units_per_m};
}

std::optional<double> depth_units_per_m_of(const std::filesystem::path& path) {
  if (path.empty()) return std::nullopt;
  try {
    return read_camera_file(path).depth_units_per_m;
  } catch (const InputError&) {
    return std::nullopt;
  }
}

core::Camera read_camera_file_for(const std::filesystem::path& path, const cv::Size& size_px,
                                  const std::filesystem::path& picture) {
  const core::Camera told = read_camera_file(path).camera;
  const cv::Size told_px = size_of(told);
  if (!told_px.empty() && told_px != size_px) {
    throw InputError(fmt::format(
        "{}: wrong calibration: it is for pictures of {} x {} pixels, {} is {} x {}", path.string(),
        told_px.width, told_px.height, picture.string(), size_px.width, size_px.height));
  }
  const core::Camera camera = with_size(told, size_px);
  if (!is_centre_inside(camera)) {
    const Eigen::Vector2d centre_px = geometry::centre_px(camera);
    throw InputError(fmt::format(
        "{}: wrong calibration: the centre ({}, {}) lies outside the image, {} is {} x {} pixels",
        path.string(), centre_px.x(), centre_px.y(), picture.string(), size_px.width,
        size_px.height));
  }
  if (const auto fault = geometry::fault_of(camera)) {
    throw InputError(fmt::format("{}: found {}; {} is {} x {} pixels", path.string(), *fault,
                                 picture.string(), size_px.width, size_px.height));
  }
  warn_of_field_of_view(path, camera);
  return camera;
}

std::string camera_file_text(const core::Camera& camera) {
  const Eigen::Vector2d f_px = geometry::focal_lengths_px(camera);
  const Eigen::Vector2d c_px = geometry::centre_px(camera);
  std::string text =
      fmt::format("{} 0 {}\n0 {} {}\n0 0 1\n{}\n", f_px.x(), c_px.x(), f_px.y(), c_px.y(),
                  std::visit([](const auto& model) { return distortion_text(model); }, camera));
  if (const cv::Size size_px = size_of(camera); size_px.width > 0) {
    text += fmt::format("# width height, px\n{} {}\n", size_px.width, size_px.height);
  }
  return text;
}

core::Camera with_size(const core::Camera& camera, const cv::Size& size_px) {
  core::Camera sized = camera;
  std::visit(
      [&](auto& model) {
        model.width_px = size_px.width;
        model.height_px = size_px.height;
      },
      sized);
  return sized;
}

bool is_centre_inside(const core::Camera& camera) {
  const Eigen::Vector2d centre_px = geometry::centre_px(camera);
  const Eigen::Vector2i size_px = geometry::picture_size_px(camera);
  return centre_px.x() >= 0.0 && centre_px.x() <= size_px.x() - 1.0 && centre_px.y() >= 0.0 &&
         centre_px.y() <= size_px.y() - 1.0;
}

}  // namespace samewhere::input
