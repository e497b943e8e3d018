#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/text_file.hpp>
#include <samewhere/geometry/camera_check.hpp>
#include <samewhere/input/calibration_files.hpp>

namespace samewhere::input {
namespace {

using core::InputError;
using core::TextLine;

void check_row(const TextLine& line, bool is_right, const char* expected) {
  if (is_right) return;
  throw InputError(
      fmt::format("{}: found {}, expected {}", line.place, fmt::join(line.words, " "), expected));
}

std::vector<double> all_numbers(const TextLine& line, std::size_t first = 0) {
  std::vector<double> numbers;
  for (std::size_t i = first; i < line.words.size(); ++i) {
    numbers.push_back(core::finite_number(line, i));
  }
  return numbers;
}

bool is_length_px(double number) {
  return number >= 1.0 && number <= geometry::kMaxPicture_px && number == std::floor(number);
}

void read_size(const TextLine& line, Calibration& calibration) {
  const std::vector<double> size = core::finite_numbers(line, 2, "width height, px");
  check_row(line, is_length_px(size[0]) && is_length_px(size[1]),
            "width height of the pictures, whole pixels");
  calibration.size_px = {static_cast<int>(size[0]), static_cast<int>(size[1])};
}

void read_distortion(const TextLine& line, Calibration& calibration) {
  const std::size_t count = line.words.size();
  if (count != 4 && count != 5 && count != 8) {
    throw InputError(fmt::format(
        "{}: found {} values, expected 4, 5 or 8 (k1 k2 p1 p2, k3, k4 k5 k6; or 2, width height, "
        "px)",
        line.place, count));
  }
  calibration.distortion = all_numbers(line);
}

// Rows that begin with a word: `fisheye k1 k2 k3 k4` and `depth_factor N`.
bool read_named_row(const TextLine& line, Calibration& calibration) {
  if (line.words.front() == "fisheye") {
    calibration.is_fisheye = true;
    calibration.distortion = all_numbers(line, 1);
    check_row(line, calibration.distortion.size() == 4, "fisheye k1 k2 k3 k4");
    return true;
  }
  if (line.words.front() == "depth_factor") {
    check_row(line, line.words.size() == 2, "depth_factor and the depth units per metre");
    calibration.depth_units_per_m = core::finite_number(line, 1);
    return true;
  }
  return false;
}

// fx fy cx cy and the distortion, where a file has one row: as DROID-SLAM and DSO give it.
void read_single_row(const TextLine& line, Calibration& calibration) {
  std::vector<double> n = all_numbers(line);
  check_row(line, n.size() == 4 || n.size() == 8 || n.size() == 9 || n.size() == 12,
            "fx fy cx cy, and then, if wanted, 4, 5 or 8 values of distortion");
  calibration.fx_px = n[0];
  calibration.fy_px = n[1];
  calibration.cx_px = n[2];
  calibration.cy_px = n[3];
  n.erase(n.begin(), n.begin() + 4);
  calibration.distortion = std::move(n);
}

void read_matrix(const std::vector<TextLine>& lines, Calibration& calibration) {
  const std::vector<double> x = core::finite_numbers(lines[0], 3, "fx 0 cx");
  const std::vector<double> y = core::finite_numbers(lines[1], 3, "0 fy cy");
  const std::vector<double> z = core::finite_numbers(lines[2], 3, "0 0 1");
  check_row(lines[0], x[0] > 0.0 && x[1] == 0.0, "fx 0 cx with fx > 0");
  check_row(lines[1], y[0] == 0.0 && y[1] > 0.0, "0 fy cy with fy > 0");
  check_row(lines[2], z[0] == 0.0 && z[1] == 0.0 && z[2] == 1.0, "0 0 1");
  calibration.fx_px = x[0];
  calibration.fy_px = y[1];
  calibration.cx_px = x[2];
  calibration.cy_px = y[2];
}

// A model of COLMAP: how many of its parameters are focal lengths, and where those of distortion
// stand in OpenCV's order.
struct ColmapModel {
  std::string_view name;
  std::size_t num_focal_lengths = 1;
  std::size_t num_distortion = 0;
  bool is_fisheye = false;
};

constexpr std::array<ColmapModel, 9> kColmapModels = {{{"SIMPLE_PINHOLE", 1, 0},
                                                       {"PINHOLE", 2, 0},
                                                       {"SIMPLE_RADIAL", 1, 1},
                                                       {"RADIAL", 1, 2},
                                                       {"OPENCV", 2, 4},
                                                       {"FULL_OPENCV", 2, 8},
                                                       {"SIMPLE_RADIAL_FISHEYE", 1, 1, true},
                                                       {"RADIAL_FISHEYE", 1, 2, true},
                                                       {"OPENCV_FISHEYE", 2, 4, true}}};

const ColmapModel& colmap_model(const TextLine& line) {
  const auto* const found =
      std::find_if(kColmapModels.begin(), kColmapModels.end(),
                   [&](const ColmapModel& model) { return model.name == line.words[1]; });
  if (found != kColmapModels.end()) return *found;
  std::vector<std::string_view> names;
  for (const ColmapModel& model : kColmapModels) names.push_back(model.name);
  throw InputError(fmt::format("{}: found the camera model {}, expected one of {}", line.place,
                               core::printable(line.words[1]), fmt::join(names, ", ")));
}

}  // namespace

Calibration read_rows_calibration(const std::filesystem::path& file) {
  Calibration calibration{.place = file.string()};
  std::vector<TextLine> lines;
  for (TextLine& line : core::read_text_lines(file)) {
    if (!read_named_row(line, calibration)) lines.push_back(std::move(line));
  }
  if (lines.size() == 1 && lines.front().words.size() >= 4) {
    read_single_row(lines.front(), calibration);
    return calibration;
  }
  if (lines.size() < 3 || lines.size() > 5) {
    throw InputError(fmt::format(
        "{}: found {} rows, expected the 3 of the camera matrix and then, if wanted, k1 k2 p1 p2 "
        "k3 and width height; or another format: {}",
        file.string(), lines.size(), kCalibrationFormats));
  }
  read_matrix(lines, calibration);
  // the last row may be the size; a row before that is the distortion
  const bool ends_with_size =
      lines.size() == 5 || (lines.size() == 4 && lines[3].words.size() == 2);
  if (ends_with_size) read_size(lines.back(), calibration);
  if (lines.size() == 5 || (lines.size() == 4 && !ends_with_size)) {
    check_row(lines[3], !calibration.is_fisheye, "one row of distortion: there is `fisheye`, too");
    read_distortion(lines[3], calibration);
  }
  return calibration;
}

Calibration read_colmap_calibration(const std::filesystem::path& file) {
  const std::vector<TextLine> lines = core::read_text_lines(file);
  if (lines.size() != 1) {
    throw InputError(
        fmt::format("{}: holds {} cameras, expected one: the pictures of a run are of "
                    "one camera",
                    file.string(), lines.size()));
  }
  const TextLine& line = lines.front();
  const ColmapModel& model = colmap_model(line);
  const std::size_t num_words = 4 + model.num_focal_lengths + 2 + model.num_distortion;
  if (line.words.size() != num_words) {
    throw InputError(fmt::format("{}: found {} values, expected the {} of {}", line.place,
                                 line.words.size(), num_words, model.name));
  }
  std::vector<double> n = all_numbers(line, 2);
  check_row(line, is_length_px(n[0]) && is_length_px(n[1]), "width and height in whole pixels");
  constexpr double kHalfPixel = 0.5;
  const std::size_t centre = 2 + model.num_focal_lengths;
  Calibration calibration{.place = file.string(),
                          .size_px = {static_cast<int>(n[0]), static_cast<int>(n[1])},
                          .fx_px = n[2],
                          .fy_px = n[centre - 1],
                          .cx_px = n[centre] - kHalfPixel,
                          .cy_px = n[centre + 1] - kHalfPixel,
                          .is_fisheye = model.is_fisheye};
  calibration.distortion.assign(n.begin() + static_cast<std::ptrdiff_t>(centre) + 2, n.end());
  if (!calibration.distortion.empty() && calibration.distortion.size() < 4) {
    calibration.distortion.resize(4, 0.0);  // k1, k2: what follows them is 0 in either model
  }
  return calibration;
}

}  // namespace samewhere::input
