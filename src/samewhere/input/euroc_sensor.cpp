#include <string>
#include <vector>

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/core/text_file.hpp>
#include <samewhere/input/camera_file.hpp>
#include <samewhere/input/euroc_sensor.hpp>
#include <samewhere/input/truth_file.hpp>

namespace samewhere::input {
namespace {

using core::InputError;
using std::filesystem::path;

// Some files begin with OpenCV's `%YAML:1.0`, which no YAML parser but OpenCV's knows; the line
// stays, empty, so that the others keep their numbers.
std::string without_opencv_header(std::string text) {
  if (!text.starts_with("%YAML:")) return text;
  return text.erase(0, std::min(text.find('\n'), text.size()));
}

YAML::Node parse(const path& file) {
  try {
    YAML::Node root =
        YAML::Load(without_opencv_header(core::read_file(file, core::kSettingsLimit)));
    if (root.IsMap()) return root;
  } catch (const YAML::Exception& error) {
    throw InputError(
        fmt::format("{}, line {}: not YAML: {}", file.string(), error.mark.line + 1, error.msg));
  }
  throw InputError(file.string() + ": is no list of keys and values, expected a sensor.yaml");
}

class SensorFile {
 public:
  explicit SensorFile(const path& file) : file_(file), root_(parse(file)) {}

  // The values of a key, one or a list, as words of a line.
  core::TextLine line(const std::string& key) const { return line_of(key, found(root_, key)); }

  // The only value of a key.
  std::string word(const std::string& key) const {
    const core::TextLine words = line(key);
    if (words.words.size() == 1) return words.words.front();
    throw InputError(
        fmt::format("{}: found {} values, expected one", words.place, words.words.size()));
  }

  std::vector<double> numbers(const std::string& key, std::size_t count,
                              const char* meaning) const {
    return core::finite_numbers(line(key), count, meaning);
  }

  double noise_density(const std::string& key) const {
    const double density = numbers(key, 1, "a noise density").front();
    if (density >= 0.0) return density;
    throw InputError(fmt::format("{}: found {}, expected at least 0", line(key).place, density));
  }

  // 0 if the file does not tell.
  double noise_density_if_told(const std::string& key) const {
    return root_[key] ? noise_density(key) : 0.0;
  }

  core::Rigid3 body_from_sensor() const {
    const YAML::Node matrix = found(root_, "T_BS");
    const core::TextLine rows =
        line_of("T_BS", matrix.IsMap() ? found(matrix, "data", "T_BS.") : matrix);
    return rigid_from_rows(rows, core::finite_numbers(rows, 16, "a pose matrix, row by row"));
  }

 private:
  YAML::Node found(const YAML::Node& parent, const std::string& key,
                   const std::string& above = "") const {
    const YAML::Node node = parent[key];
    if (node) return node;
    throw InputError(fmt::format("{}: has no {}{}", file_.string(), above, key));
  }

  core::TextLine line_of(const std::string& key, const YAML::Node& node) const {
    core::TextLine line{fmt::format("{}, line {}: {}", file_.string(), node.Mark().line + 1, key),
                        {}};
    if (node.IsScalar()) line.words.push_back(node.Scalar());
    if (!node.IsSequence()) return line;
    for (const YAML::Node& entry : node) {
      if (!entry.IsScalar()) throw InputError(line.place + ": expected plain values");
      line.words.push_back(entry.Scalar());
    }
    return line;
  }

  path file_;
  YAML::Node root_;
};

void require_word(const SensorFile& sensor, const std::string& key, const std::string& expected) {
  const std::string word = sensor.word(key);
  if (word == expected) return;
  throw InputError(fmt::format("{}: found {}, expected {}, the only one that is read",
                               sensor.line(key).place, word, expected));
}

int pixels(const SensorFile& sensor, double number) {
  constexpr double kMax_px = 100000.0;
  if (number >= 1.0 && number <= kMax_px && number == static_cast<int>(number)) {
    return static_cast<int>(number);
  }
  throw InputError(fmt::format("{}: found {}, expected width and height in pixels",
                               sensor.line("resolution").place, number));
}

void read_distortion(const SensorFile& sensor, core::PinholeRadtan& camera) {
  require_word(sensor, "distortion_model", "radial-tangential");
  const bool has_k3 = sensor.line("distortion_coefficients").words.size() == 5;
  const std::vector<double> k =
      sensor.numbers("distortion_coefficients", has_k3 ? 5 : 4, "k1 k2 p1 p2");
  camera.k1 = k[0];
  camera.k2 = k[1];
  camera.p1 = k[2];
  camera.p2 = k[3];
  camera.k3 = has_k3 ? k[4] : 0.0;
}

}  // namespace

EurocCamera read_euroc_camera(const path& file) {
  const SensorFile sensor(file);
  require_word(sensor, "camera_model", "pinhole");
  const std::vector<double> size = sensor.numbers("resolution", 2, "width height");
  const std::vector<double> k = sensor.numbers("intrinsics", 4, "fu fv cu cv");
  if (!(k[0] > 0.0 && k[1] > 0.0)) {
    throw InputError(fmt::format("{}: found focal lengths {} and {}, expected positive ones",
                                 sensor.line("intrinsics").place, k[0], k[1]));
  }
  core::PinholeRadtan camera{.width_px = pixels(sensor, size[0]),
                             .height_px = pixels(sensor, size[1]),
                             .fx_px = k[0],
                             .fy_px = k[1],
                             .cx_px = k[2],
                             .cy_px = k[3]};
  if (!is_centre_inside(camera)) {
    throw InputError(fmt::format("{}: the centre ({}, {}) lies outside the image of {} x {} pixels",
                                 sensor.line("intrinsics").place, camera.cx_px, camera.cy_px,
                                 camera.width_px, camera.height_px));
  }
  read_distortion(sensor, camera);
  return {camera, sensor.body_from_sensor()};
}

core::Imu read_euroc_imu(const path& file) {
  const SensorFile sensor(file);
  return {
      .body_from_imu = sensor.body_from_sensor(),
      .gyroscope_noise_rad_s_sqrt_hz = sensor.noise_density("gyroscope_noise_density"),
      .accelerometer_noise_m_s2_sqrt_hz = sensor.noise_density("accelerometer_noise_density"),
      .gyroscope_bias_walk_rad_s2_sqrt_hz = sensor.noise_density_if_told("gyroscope_random_walk"),
      .accelerometer_bias_walk_m_s3_sqrt_hz =
          sensor.noise_density_if_told("accelerometer_random_walk")};
}

core::Rigid3 read_euroc_body_from_sensor(const path& file) {
  return SensorFile(file).body_from_sensor();
}

}  // namespace samewhere::input
