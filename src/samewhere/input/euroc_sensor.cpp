#include <string>
#include <vector>

#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/text_file.hpp>
#include <samewhere/geometry/camera_check.hpp>
#include <samewhere/input/calibration_files.hpp>
#include <samewhere/input/euroc_sensor.hpp>
#include <samewhere/input/truth_file.hpp>
#include <samewhere/input/yaml_keys.hpp>

namespace samewhere::input {
namespace {

using core::InputError;
using std::filesystem::path;

std::vector<double> numbers(const YamlKeys& sensor, const std::string& key, std::size_t count,
                            const char* meaning) {
  return core::finite_numbers(sensor.line(key), count, meaning);
}

double noise_density(const YamlKeys& sensor, const std::string& key) {
  const double density = numbers(sensor, key, 1, "a noise density").front();
  if (density >= 0.0) return density;
  throw InputError(
      fmt::format("{}: found {}, expected at least 0", sensor.line(key).place, density));
}

// 0 if the file does not tell.
double noise_density_if_told(const YamlKeys& sensor, const std::string& key) {
  return sensor.has(key) ? noise_density(sensor, key) : 0.0;
}

core::Rigid3 body_from(const YamlKeys& sensor) {
  const core::TextLine rows = sensor.line("T_BS");
  const core::Rigid3 body_from_sensor =
      rigid_from_rows(rows, core::finite_numbers(rows, 16, "a pose matrix, row by row"));
  const double distance_m = body_from_sensor.translation.norm();
  if (distance_m <= geometry::kMaxBaseline_m) return body_from_sensor;
  throw InputError(fmt::format("{}: puts the sensor {:.4g} m from the body, expected at most {} m",
                               rows.place, distance_m, geometry::kMaxBaseline_m));
}

YamlKeys read_sensor(const path& file) { return {file, core::read_text(file)}; }

}  // namespace

EurocCamera read_euroc_camera(const path& file) {
  const YamlKeys sensor = read_sensor(file);
  for (const char* const key : {"intrinsics", "resolution"}) {
    if (!sensor.has(key)) throw InputError(fmt::format("{}: has no {}", file.string(), key));
  }
  return {camera_of(read_yaml_calibration(sensor)), body_from(sensor)};
}

core::Imu read_euroc_imu(const path& file) {
  const YamlKeys sensor = read_sensor(file);
  return {
      .body_from_imu = body_from(sensor),
      .gyroscope_noise_rad_s_sqrt_hz = noise_density(sensor, "gyroscope_noise_density"),
      .accelerometer_noise_m_s2_sqrt_hz = noise_density(sensor, "accelerometer_noise_density"),
      .gyroscope_bias_walk_rad_s2_sqrt_hz = noise_density_if_told(sensor, "gyroscope_random_walk"),
      .accelerometer_bias_walk_m_s3_sqrt_hz =
          noise_density_if_told(sensor, "accelerometer_random_walk")};
}

core::Rigid3 read_euroc_body_from_sensor(const path& file) { return body_from(read_sensor(file)); }

}  // namespace samewhere::input
