#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>

#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/text_file.hpp>
#include <samewhere/geometry/camera_check.hpp>
#include <samewhere/input/calibration.hpp>

namespace samewhere::input {
namespace {

using core::InputError;

// Lower case without what joins words: "Kannala-Brandt_8" is "kannalabrandt8".
std::string plain(const std::string& name) {
  std::string letters;
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    if (std::isalnum(byte) != 0) letters += static_cast<char>(std::tolower(byte));
  }
  return letters;
}

template <std::size_t N>
bool is_among(const std::string& word, const std::array<std::string_view, N>& words) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

constexpr std::array<std::string_view, 9> kFisheyeNames = {
    "equidistant",    "equi", "fisheye", "opencvfisheye", "kannalabrandt", "kannalabrandt4",
    "kannalabrandt8", "kb4",  "kb"};

constexpr std::array<std::string_view, 22> kPinholeNames = {"",
                                                            "pinhole",
                                                            "simplepinhole",
                                                            "perspective",
                                                            "rectified",
                                                            "none",
                                                            "nodistortion",
                                                            "radtan",
                                                            "radialtangential",
                                                            "radialtangential4",
                                                            "plumbbob",
                                                            "brownconrady",
                                                            "brown",
                                                            "opencv",
                                                            "fullopencv",
                                                            "simpleradial",
                                                            "radial",
                                                            "rational",
                                                            "rationalpolynomial",
                                                            "rationalpolynomial8",
                                                            "radtan8",
                                                            "distortionbrownconrady"};

// OpenCV has 12 and 14 numbers, too: thin prisms and tilted sensors, which are mostly 0.
std::vector<double> without_zeros_behind(std::vector<double> k, std::size_t most) {
  while (k.size() > most && k.back() == 0.0) k.pop_back();
  return k;
}

core::Camera fisheye_of(const Calibration& c) {
  const std::vector<double> k = without_zeros_behind(c.distortion, 4);
  if (k.size() != 4 && !k.empty()) {
    throw InputError(
        fmt::format("{}: found {} distortion values, expected the 4 of a fisheye, k1 "
                    "k2 k3 k4",
                    c.place, k.size()));
  }
  core::KannalaBrandt camera{.width_px = c.size_px.width,
                             .height_px = c.size_px.height,
                             .fx_px = c.fx_px,
                             .fy_px = c.fy_px,
                             .cx_px = c.cx_px,
                             .cy_px = c.cy_px};
  if (!k.empty()) {
    camera.k1 = k[0];
    camera.k2 = k[1];
    camera.k3 = k[2];
    camera.k4 = k[3];
  }
  return camera;
}

core::Camera pinhole_of(const Calibration& c) {
  std::vector<double> k = without_zeros_behind(c.distortion, 8);
  if (!k.empty() && k.size() != 4 && k.size() != 5 && k.size() != 8) {
    throw InputError(fmt::format(
        "{}: found {} distortion values, expected 4 (k1 k2 p1 p2), 5 (and k3) or 8 (and k4 k5 k6)",
        c.place, k.size()));
  }
  k.resize(8, 0.0);
  return core::PinholeRadtan{.width_px = c.size_px.width,
                             .height_px = c.size_px.height,
                             .fx_px = c.fx_px,
                             .fy_px = c.fy_px,
                             .cx_px = c.cx_px,
                             .cy_px = c.cy_px,
                             .k1 = k[0],
                             .k2 = k[1],
                             .p1 = k[2],
                             .p2 = k[3],
                             .k3 = k[4],
                             .k4 = k[5],
                             .k5 = k[6],
                             .k6 = k[7]};
}

}  // namespace

bool is_fisheye_model(const std::string& place, const std::string& model) {
  const std::string name = plain(model);
  if (is_among(name, kFisheyeNames)) return true;
  if (is_among(name, kPinholeNames)) return false;
  throw InputError(fmt::format(
      "{}: found the camera model {}, expected pinhole with radial-tangential (radtan, plumb_bob) "
      "or rational distortion, or fisheye (equidistant, Kannala-Brandt)",
      place, core::printable(model)));
}

core::Camera camera_of(const Calibration& calibration) {
  const core::Camera camera =
      calibration.is_fisheye ? fisheye_of(calibration) : pinhole_of(calibration);
  if (const auto fault = geometry::fault_of(camera)) {
    throw InputError(fmt::format("{}: found {}", calibration.place, *fault));
  }
  return camera;
}

}  // namespace samewhere::input
