#include <array>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <opencv2/core.hpp>
#include <spdlog/spdlog.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/geometry/camera_check.hpp>
#include <samewhere/input/calibration_files.hpp>
#include <samewhere/input/yaml_keys.hpp>

namespace samewhere::input {
namespace {

using core::InputError;
using std::filesystem::path;

constexpr double kHalfPixel = 0.5;  // where (0, 0) is the corner of a pixel and not its centre

void read_size(const YamlKeys& keys, Calibration& calibration) {
  const auto width = keys.first_of({"Camera.width", "Camera.imWidth", "image_width", "image_Width",
                                    "imageWidth", "width", "w", "W"});
  const auto height = keys.first_of({"Camera.height", "Camera.imHeight", "image_height",
                                     "image_Height", "imageHeight", "height", "h", "H"});
  if (width && height) calibration.size_px = {keys.pixels(*width), keys.pixels(*height)};
}

void read_depth_units(const YamlKeys& keys, Calibration& calibration) {
  const auto key =
      keys.first_of({"depth_factor", "RGBD.DepthMapFactor", "DepthMapFactor", "png_depth_scale"});
  if (key) calibration.depth_units_per_m = keys.number(*key);
}

void read_model(const YamlKeys& keys, std::initializer_list<const char*> names,
                Calibration& calibration) {
  for (const char* const name : names) {
    if (!keys.first_of({name})) continue;
    const bool is_fisheye = is_fisheye_model(keys.line(name).place, keys.word(name));
    calibration.is_fisheye = calibration.is_fisheye || is_fisheye;
  }
}

void set_intrinsics(const std::vector<double>& k, Calibration& calibration) {
  calibration.fx_px = k[0];
  calibration.fy_px = k[1];
  calibration.cx_px = k[2];
  calibration.cy_px = k[3];
}

// ORB-SLAM2 and 3: Camera.fx or Camera1.fx. What Camera.newWidth says is done to the pictures there
// and not here.
void read_orb_slam(const YamlKeys& keys, const std::string& prefix, Calibration& calibration) {
  set_intrinsics({keys.number(prefix + ".fx"), keys.number(prefix + ".fy"),
                  keys.number(prefix + ".cx"), keys.number(prefix + ".cy")},
                 calibration);
  read_model(keys, {"Camera.type"}, calibration);
  const auto k = [&](const char* name) { return keys.number_or(prefix + "." + name, 0.0); };
  if (calibration.is_fisheye) {
    calibration.distortion = {k("k1"), k("k2"), k("k3"), k("k4")};
  } else {
    calibration.distortion = {k("k1"), k("k2"), k("p1"), k("p2"), k("k3")};
  }
}

// Kalibr, and the sensor.yaml of EuRoC.
void read_kalibr(const YamlKeys& keys, Calibration& calibration) {
  const std::vector<double> k = keys.numbers("intrinsics");
  read_model(keys, {"camera_model", "distortion_model"}, calibration);
  if (k.size() != 4) {
    throw InputError(fmt::format("{}: found {} values, expected fx fy cx cy",
                                 keys.line("intrinsics").place, k.size()));
  }
  set_intrinsics(k, calibration);
  if (const auto key = keys.first_of({"distortion_coeffs", "distortion_coefficients"})) {
    calibration.distortion = keys.numbers(*key);
  }
  if (!keys.has("resolution")) return;
  const core::TextLine size = keys.line("resolution");
  const std::vector<double> size_px = core::finite_numbers(size, 2, "width height");
  for (const double length_px : size_px) {
    if (length_px >= 1.0 && length_px <= geometry::kMaxPicture_px &&
        length_px == std::floor(length_px))
      continue;
    throw InputError(
        fmt::format("{}: found {}, expected width and height in pixels", size.place, length_px));
  }
  calibration.size_px = {static_cast<int>(size_px[0]), static_cast<int>(size_px[1])};
}

constexpr std::initializer_list<const char*> kMatrixNames = {"camera_matrix",
                                                             "Camera_Matrix",
                                                             "cameraMatrix",
                                                             "camera_matrix_left",
                                                             "intrinsic_matrix",
                                                             "K",
                                                             "k",
                                                             "M1",
                                                             "mtx"};

// fx fy cx cy of a matrix row by row, or column by column (Open3D).
std::vector<double> intrinsics_of_matrix(const core::TextLine& line, const std::vector<double>& m) {
  if (m.size() == 4) return m;
  constexpr std::array<std::size_t, 9> kTransposed = {0, 3, 6, 1, 4, 7, 2, 5, 8};
  const auto is_matrix = [&](const std::array<std::size_t, 9>& at) {
    return m[at[1]] == 0.0 && m[at[3]] == 0.0 && m[at[6]] == 0.0 && m[at[7]] == 0.0 &&
           m[at[8]] == 1.0;
  };
  if (m.size() == 9 && is_matrix({0, 1, 2, 3, 4, 5, 6, 7, 8})) return {m[0], m[4], m[2], m[5]};
  if (m.size() == 9 && is_matrix(kTransposed)) return {m[0], m[4], m[6], m[7]};
  throw InputError(fmt::format("{}: found {}, expected the matrix fx 0 cx 0 fy cy 0 0 1",
                               line.place, fmt::join(m, " ")));
}

// OpenCV and ROS.
void read_opencv(const YamlKeys& keys, const std::string& matrix, Calibration& calibration) {
  set_intrinsics(intrinsics_of_matrix(keys.line(matrix), keys.numbers(matrix)), calibration);
  read_model(keys, {"distortion_model", "camera_model"}, calibration);
  if (keys.number_or("fisheye_model", 0.0) != 0.0) calibration.is_fisheye = true;
  const auto distortion =
      keys.first_of({"distortion_coefficients", "Distortion_Coefficients", "distCoeffs",
                     "dist_coeffs", "dist_coeff", "distortion", "D", "d", "D1", "dist"});
  if (distortion) calibration.distortion = keys.numbers(*distortion);
}

// VINS (camodocal): projection_parameters and distortion_parameters.
void read_vins(const YamlKeys& keys, Calibration& calibration) {
  const YamlKeys k = keys.below("projection_parameters");
  read_model(keys, {"model_type"}, calibration);
  if (calibration.is_fisheye) {
    set_intrinsics({k.number("mu"), k.number("mv"), k.number("u0"), k.number("v0")}, calibration);
    calibration.distortion = {k.number("k2"), k.number("k3"), k.number("k4"), k.number("k5")};
    return;
  }
  set_intrinsics({k.number("fx"), k.number("fy"), k.number("cx"), k.number("cy")}, calibration);
  if (!keys.has_map("distortion_parameters")) return;
  const YamlKeys d = keys.below("distortion_parameters");
  calibration.distortion = {d.number("k1"), d.number("k2"), d.number("p1"), d.number("p2")};
}

// One key a number: fx fy cx cy, fl_x fl_y (nerfstudio), ppx ppy (RealSense).
void read_plain(const YamlKeys& keys, const std::string& fx, Calibration& calibration) {
  const bool is_nerf = fx == "fl_x";
  const std::string fy = is_nerf ? "fl_y" : "fy";
  set_intrinsics(
      {keys.number(fx), keys.has(fy) ? keys.number(fy) : keys.number(fx),
       keys.number(keys.has("ppx") ? "ppx" : "cx"), keys.number(keys.has("ppy") ? "ppy" : "cy")},
      calibration);
  if (is_nerf) {
    calibration.cx_px -= kHalfPixel;
    calibration.cy_px -= kHalfPixel;
  }
  read_model(keys, {"camera_model", "distortion_model", "model"}, calibration);
  const auto k = [&](const char* name) { return keys.number_or(name, 0.0); };
  if (const auto list = keys.first_of({"coeffs", "distortion", "distortion_coefficients"})) {
    calibration.distortion = keys.numbers(*list);
  } else if (calibration.is_fisheye) {
    calibration.distortion = {k("k1"), k("k2"), k("k3"), k("k4")};
  } else {
    calibration.distortion = {k("k1"), k("k2"), k("p1"), k("p2"),
                              k("k3"), k("k4"), k("k5"), k("k6")};
  }
}

// Whether the keys are of one of the formats; then the calibration is filled.
bool read_known(const YamlKeys& keys, Calibration& calibration) {
  if (keys.has("Camera.fx") || keys.has("Camera1.fx")) {
    read_orb_slam(keys, keys.has("Camera1.fx") ? "Camera1" : "Camera", calibration);
  } else if (keys.has_list("intrinsics")) {
    read_kalibr(keys, calibration);
    return true;
  } else if (const auto matrix = keys.first_of(kMatrixNames)) {
    read_opencv(keys, *matrix, calibration);
  } else if (keys.has_map("projection_parameters")) {
    read_vins(keys, calibration);
  } else if (const auto fx = keys.first_of({"fx", "fl_x"})) {
    read_plain(keys, *fx, calibration);
  } else {
    return false;
  }
  read_size(keys, calibration);
  return true;
}

// Cameras that lie one level deeper: cam0, cam1 of Kalibr, or `camera`, `intrinsics`.
std::vector<std::string> cameras_below(const YamlKeys& keys) {
  std::vector<std::string> cameras;
  for (const std::string& name : keys.names()) {
    const bool is_camera = name.starts_with("cam") || name.starts_with("intrinsic") ||
                           name.starts_with("calib") || name == "left" || name == "color" ||
                           name == "rgb";
    if (is_camera && keys.has_map(name)) cameras.push_back(name);
  }
  return cameras;
}

// As YAML would give it; what lies deeper than a matrix is of no camera.
YAML::Node yaml_of(const cv::FileNode& node, int depth = 0) {
  constexpr int kMostDepth = 3;
  constexpr std::size_t kMostEntries = 1000;
  YAML::Node yaml;
  if (node.isInt() || node.isReal()) {
    yaml = fmt::format("{}", static_cast<double>(node));
  } else if (node.isString()) {
    yaml = static_cast<std::string>(node);
  } else if ((node.isMap() || node.isSeq()) && depth < kMostDepth && node.size() < kMostEntries) {
    for (const cv::FileNode entry : node) {
      if (node.isMap()) {
        yaml.force_insert(entry.name(), yaml_of(entry, depth + 1));
      } else {
        yaml.push_back(yaml_of(entry, depth + 1));
      }
    }
  }
  return yaml;
}

}  // namespace

Calibration read_yaml_calibration(const YamlKeys& keys) {
  Calibration calibration{.place = keys.file().string()};
  read_depth_units(keys, calibration);
  if (read_known(keys, calibration)) return calibration;
  const std::vector<std::string> cameras = cameras_below(keys);
  if (!cameras.empty()) {
    const YamlKeys camera = keys.below(cameras.front());
    read_depth_units(camera, calibration);
    if (read_known(camera, calibration)) {
      if (cameras.size() > 1) {
        spdlog::warn("{}: holds the cameras {}; {} is taken", keys.file().string(),
                     fmt::join(cameras, ", "), cameras.front());
      }
      return calibration;
    }
  }
  throw InputError(
      fmt::format("{}: has none of the keys that a camera is read from (Camera.fx, "
                  "camera_matrix, K, intrinsics, fx, fl_x); expected {}",
                  keys.file().string(), kCalibrationFormats));
}

Calibration read_xml_calibration(const path& file, const std::string& text) {
  YAML::Node root;
  try {
    const cv::FileStorage storage(
        text, cv::FileStorage::READ | cv::FileStorage::MEMORY | cv::FileStorage::FORMAT_XML);
    root = yaml_of(storage.root());
  } catch (const cv::Exception& error) {
    throw InputError(
        fmt::format("{}: not XML of OpenCV: {}", file.string(), core::printable(error.err)));
  }
  if (!root.IsMap()) throw InputError(file.string() + ": not XML of OpenCV: holds no keys");
  return read_yaml_calibration(YamlKeys(file, root));
}

}  // namespace samewhere::input
