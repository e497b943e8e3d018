#include <charconv>
#include <cstdint>

#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/input/associate.hpp>
#include <samewhere/input/csv_file.hpp>
#include <samewhere/input/euroc_sensor.hpp>
#include <samewhere/input/file_names.hpp>
#include <samewhere/input/formats.hpp>
#include <samewhere/input/truth_file.hpp>

namespace samewhere::input {
namespace {

using core::InputError;
using std::filesystem::path;

// A line of a data.csv: its first word is a stamp.
struct StampedLine {
  core::TextLine line;
  std::int64_t stamp_ns = 0;

  // Whole seconds apart from the rest: a count of nanoseconds since 1970 has more digits than a
  // double.
  double stamp_s() const {
    constexpr std::int64_t kNs_per_s = 1'000'000'000;
    const std::int64_t whole_s = stamp_ns / kNs_per_s;
    return static_cast<double>(whole_s) +
           static_cast<double>(stamp_ns % kNs_per_s) / static_cast<double>(kNs_per_s);
  }
};

std::int64_t parse_stamp_ns(const core::TextLine& line) {
  const std::string& word = line.words.front();
  std::int64_t stamp_ns = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), stamp_ns);
  if (error == std::errc{} && end == word.data() + word.size() && stamp_ns >= 0) return stamp_ns;
  throw InputError(
      fmt::format("{}: found a stamp that is no whole number of nanoseconds, expected 'stamp,...'",
                  line.place));
}

std::vector<StampedLine> read_stamped_lines(const path& file) {
  std::vector<StampedLine> lines;
  for (core::TextLine& line : read_csv_lines(file)) {
    const std::int64_t stamp_ns = parse_stamp_ns(line);
    if (!lines.empty() && stamp_ns <= lines.back().stamp_ns) {
      throw InputError(fmt::format("{}: found stamp {} after {}, expected stamps that rise",
                                   line.place, stamp_ns, lines.back().stamp_ns));
    }
    lines.push_back({std::move(line), stamp_ns});
  }
  return lines;
}

// The numbers behind the stamp, at least `min_count`.
std::vector<double> numbers_of(const StampedLine& row, std::size_t min_count, const char* meaning) {
  if (row.line.words.size() < min_count + 1) {
    throw InputError(fmt::format("{}: found {} values, expected at least {} (stamp {})",
                                 row.line.place, row.line.words.size(), min_count + 1, meaning));
  }
  std::vector<double> numbers;
  for (std::size_t i = 1; i <= min_count; ++i) numbers.push_back(core::finite_number(row.line, i));
  return numbers;
}

path image_of(const path& camera, const StampedLine& row) {
  if (row.line.words.size() != 2 || row.line.words[1].empty()) {
    throw InputError(row.line.place + ": expected 'stamp,filename'");
  }
  path image = camera / "data" / row.line.words[1];
  if (is_there(image)) return image;
  throw InputError(fmt::format("{}: the image {} does not exist", row.line.place, image.string()));
}

std::vector<double> stamps_of(const std::vector<StampedLine>& rows) {
  std::vector<double> stamps_s;
  for (const StampedLine& row : rows) stamps_s.push_back(row.stamp_s());
  return stamps_s;
}

void add_camera(const path& sensor_file, core::Rig& rig) {
  const EurocCamera found = read_euroc_camera(sensor_file);
  rig.cameras.emplace_back(found.camera);
  rig.body_from_camera.push_back(found.body_from_camera);
}

// The second camera: each frame of the first gets the picture that is nearest in time.
void add_partners(const path& camera, const std::vector<StampedLine>& firsts,
                  double max_difference_s, Recording& recording) {
  const std::vector<StampedLine> seconds = read_stamped_lines(camera / "data.csv");
  const auto partners = associate(stamps_of(firsts), stamps_of(seconds), max_difference_s);
  for (std::size_t i = 0; i < firsts.size(); ++i) {
    if (!partners[i]) {
      throw InputError(fmt::format("{}: the image {} has no partner within {} s in {}",
                                   firsts[i].line.place, firsts[i].line.words[1], max_difference_s,
                                   (camera / "data.csv").string()));
    }
    recording.frames[i].images.push_back(image_of(camera, seconds[*partners[i]]));
  }
  add_camera(camera / "sensor.yaml", recording.rig);
}

std::vector<core::ImuSample> read_imu_samples(const path& file) {
  std::vector<core::ImuSample> samples;
  for (const StampedLine& row : read_stamped_lines(file)) {
    const std::vector<double> n = numbers_of(row, 6, "wx wy wz ax ay az");
    samples.push_back({row.stamp_s(), {n[0], n[1], n[2]}, {n[3], n[4], n[5]}});
  }
  return samples;
}

core::Rigid3 world_from_sensor(const StampedLine& row) {
  const std::vector<double> n = numbers_of(row, 7, "x y z qw qx qy qz");
  const Eigen::Quaterniond rotation(n[3], n[4], n[5], n[6]);
  constexpr double kMaxNormError = 1e-2;  // files round
  if (std::abs(rotation.norm() - 1.0) > kMaxNormError) {
    throw InputError(fmt::format("{}: found a quaternion of norm {}, expected a unit quaternion",
                                 row.line.place, rotation.norm()));
  }
  return {rotation.normalized(), {n[0], n[1], n[2]}};
}

core::InertialTruth inertial_truth(const StampedLine& row, const core::Rigid3& body_from_sensor) {
  const std::vector<double> n =
      numbers_of(row, 16, "x y z qw qx qy qz vx vy vz bwx bwy bwz bax bay baz");
  return {
      .stamp_s = row.stamp_s(),
      .velocity_m_s = {n[7], n[8], n[9]},
      .gyroscope_bias_rad_s = body_from_sensor.rotation * Eigen::Vector3d(n[10], n[11], n[12]),
      .accelerometer_bias_m_s2 = body_from_sensor.rotation * Eigen::Vector3d(n[13], n[14], n[15])};
}

struct States {
  core::Trajectory trajectory;  // of camera 0
  std::vector<core::InertialTruth> inertial;
};

// From those of the sensor that the truth belongs to. There is inertial truth where the first row
// has all of its columns (a file may hold poses alone, or poses and velocities) and the sensor sits
// where the body is: the velocity of another point would tell the body's only together with the
// turning.
States read_states(const path& truth, const core::Rigid3& body_from_camera) {
  const core::Rigid3 body_from_sensor = is_there(truth / "sensor.yaml")
                                            ? read_euroc_body_from_sensor(truth / "sensor.yaml")
                                            : core::Rigid3{};
  const core::Rigid3 sensor_from_camera = inverse(body_from_sensor) * body_from_camera;
  const std::vector<StampedLine> rows = read_stamped_lines(truth / "data.csv");
  constexpr std::size_t kNumColumns = 17;
  const bool is_whole = !rows.empty() && rows.front().line.words.size() >= kNumColumns;
  const bool is_at_body = body_from_sensor.translation.isZero();
  States states;
  for (const StampedLine& row : rows) {
    states.trajectory.push_back({row.stamp_s(), world_from_sensor(row) * sensor_from_camera});
    if (is_whole && is_at_body) states.inertial.push_back(inertial_truth(row, body_from_sensor));
  }
  return states;
}

}  // namespace

std::optional<Recording> find_euroc(const path& folder, const Config& config) {
  const bool is_around = is_folder(folder / "mav0");
  if (!is_around && !is_there(folder / "cam0" / "data.csv")) return std::nullopt;
  const path mav = is_around ? folder / "mav0" : folder;
  Recording recording{.format = "EuRoC"};
  const std::vector<StampedLine> rows = read_stamped_lines(mav / "cam0" / "data.csv");
  if (rows.empty()) throw InputError((mav / "cam0" / "data.csv").string() + ": lists no image");
  for (const StampedLine& row : rows) {
    const path image = image_of(mav / "cam0", row);
    recording.frames.push_back({image.filename().string(), row.stamp_s(), {image}});
  }
  add_camera(mav / "cam0" / "sensor.yaml", recording.rig);
  if (is_folder(mav / "cam1")) {
    add_partners(mav / "cam1", rows, config.max_stamp_difference_s, recording);
  }
  if (is_folder(mav / "imu0")) {
    recording.imu = read_imu_samples(mav / "imu0" / "data.csv");
    recording.rig.imu = read_euroc_imu(mav / "imu0" / "sensor.yaml");
  }
  // tables that are no part of the format lie beside mav0
  const path whole = std::filesystem::absolute(mav).lexically_normal();
  const bool is_mav0 = is_around || whole.filename() == "mav0";
  recording.truth =
      read_truth(is_mav0 ? whole.parent_path() : folder, static_cast<int>(rows.size()));
  const path truth = mav / "state_groundtruth_estimate0";
  if (is_folder(truth)) {
    States states = read_states(truth, recording.rig.body_from_camera.front());
    recording.truth.trajectory = std::move(states.trajectory);
    recording.truth.inertial = std::move(states.inertial);
  }
  return recording;
}

}  // namespace samewhere::input
