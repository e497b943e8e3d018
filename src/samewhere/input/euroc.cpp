#include <charconv>
#include <cstdint>
#include <functional>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/input/associate.hpp>
#include <samewhere/input/csv_file.hpp>
#include <samewhere/input/euroc_sensor.hpp>
#include <samewhere/input/file_names.hpp>
#include <samewhere/input/formats.hpp>
#include <samewhere/input/left_out.hpp>
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

std::vector<core::TextLine> table_rows(const path& file) {
  std::vector<core::TextLine> lines = read_csv_lines(file);
  core::drop_column_names(lines);
  return lines;
}

// The rows of a list of pictures, each of which counts.
std::vector<StampedLine> read_stamped_lines(const path& file) {
  std::vector<StampedLine> lines;
  for (core::TextLine& line : table_rows(file)) {
    const std::int64_t stamp_ns = parse_stamp_ns(line);
    if (!lines.empty() && stamp_ns <= lines.back().stamp_ns) {
      throw InputError(fmt::format("{}: found stamp {} after {}, expected stamps that rise",
                                   line.place, stamp_ns, lines.back().stamp_ns));
    }
    lines.push_back({std::move(line), stamp_ns});
  }
  return lines;
}

// The rows of a table without which a run goes on: those that `read` throws InputError for are
// left out and warned of.
void read_sound_rows(const path& file, const char* nouns,
                     const std::function<void(const StampedLine&)>& read) {
  const std::vector<core::TextLine> lines = table_rows(file);
  LeftOut left_out;
  for (const core::TextLine& line : lines) {
    try {
      read({line, parse_stamp_ns(line)});
    } catch (const InputError& error) {
      left_out.add(error.what());
    }
  }
  left_out.warn(lines.size(), nouns);
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

// Empty if it does not exist, which `left_out` then says.
path image_of(const path& camera, const StampedLine& row, LeftOut& left_out) {
  if (row.line.words.size() < 2 || row.line.words[1].empty()) {
    throw InputError(row.line.place + ": expected 'stamp,filename'");
  }
  path image = camera / "data" / row.line.words[1];
  if (is_there(image)) return image;
  left_out.add(fmt::format("{}: the image {} does not exist", row.line.place, image.string()));
  return {};
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

// Frames of the first camera alone.
void add_first_pictures(const path& camera, const std::vector<StampedLine>& rows,
                        Recording& recording) {
  LeftOut left_out;
  for (const StampedLine& row : rows) {
    const path image = image_of(camera, row, left_out);
    if (!image.empty())
      recording.frames.push_back({image.filename().string(), row.stamp_s(), {image}});
  }
  left_out.refuse_most(rows.size(), "pictures");
  left_out.warn(rows.size(), "pictures");
}

// The second camera: each frame of the first gets the picture that is nearest in time. Frames
// without one are left out.
void add_partners(const path& camera, double max_difference_s, Recording& recording) {
  const std::vector<StampedLine> seconds = read_stamped_lines(camera / "data.csv");
  std::vector<double> stamps_s;
  for (const FrameFiles& frame : recording.frames) stamps_s.push_back(frame.stamp_s);
  const auto partners = associate(stamps_s, stamps_of(seconds), max_difference_s);
  std::vector<FrameFiles> pairs;
  LeftOut left_out;
  for (std::size_t i = 0; i < recording.frames.size(); ++i) {
    FrameFiles& frame = recording.frames[i];
    if (!partners[i]) {
      left_out.add(fmt::format("{}: no partner within {} s in {}", frame.images.front().string(),
                               max_difference_s, (camera / "data.csv").string()));
      continue;
    }
    const path image = image_of(camera, seconds[*partners[i]], left_out);
    if (image.empty()) continue;
    frame.images.push_back(image);
    pairs.push_back(std::move(frame));
  }
  left_out.refuse_most(recording.frames.size(), "pictures of camera 0");
  left_out.warn(recording.frames.size(), "pairs of pictures");
  recording.frames = std::move(pairs);
}

// Stamps rise; a row whose stamp does not is left out.
std::vector<core::ImuSample> read_imu_samples(const path& file) {
  std::vector<core::ImuSample> samples;
  read_sound_rows(file, "inertial measurements", [&samples](const StampedLine& row) {
    const std::vector<double> n = numbers_of(row, 6, "wx wy wz ax ay az");
    if (!samples.empty() && row.stamp_s() <= samples.back().stamp_s)
      throw InputError(row.line.place + ": found a stamp that does not rise");
    samples.push_back({row.stamp_s(), {n[0], n[1], n[2]}, {n[3], n[4], n[5]}});
  });
  return samples;
}

void read_imu(const path& folder, Recording& recording) {
  const bool is_sound = read_if_sound("the inertial measurements are not used", [&] {
    recording.imu = read_imu_samples(folder / "data.csv");
    recording.rig.imu = read_euroc_imu(folder / "sensor.yaml");
  });
  if (!is_sound) recording.imu.clear();
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
// turning. Rows that cannot be read, and those of a stamp that an earlier one has, are left out.
States read_states(const path& truth, const core::Rigid3& body_from_camera) {
  const core::Rigid3 body_from_sensor = is_there(truth / "sensor.yaml")
                                            ? read_euroc_body_from_sensor(truth / "sensor.yaml")
                                            : core::Rigid3{};
  const core::Rigid3 sensor_from_camera = inverse(body_from_sensor) * body_from_camera;
  const bool is_at_body = body_from_sensor.translation.isZero();
  constexpr std::size_t kNumColumns = 17;
  States states;
  std::optional<bool> is_whole;
  read_sound_rows(truth / "data.csv", "poses of the ground truth", [&](const StampedLine& row) {
    const core::Rigid3 world_from_camera = world_from_sensor(row) * sensor_from_camera;
    if (!is_whole) is_whole = row.line.words.size() >= kNumColumns;
    if (!states.trajectory.empty() && row.stamp_s() <= states.trajectory.back().stamp_s)
      throw InputError(row.line.place + ": found a stamp that does not rise");
    if (*is_whole && is_at_body) states.inertial.push_back(inertial_truth(row, body_from_sensor));
    states.trajectory.push_back({row.stamp_s(), world_from_camera});
  });
  return states;
}

void add_states(const path& truth, bool has_rig, Recording& recording) {
  if (!has_rig) {
    spdlog::warn("{}: is the truth of the body; without T_BS of camera 0 it is not used",
                 truth.string());
    return;
  }
  read_if_sound("the run goes on without this ground truth", [&] {
    States states = read_states(truth, recording.rig.body_from_camera.front());
    recording.truth.trajectory = std::move(states.trajectory);
    recording.truth.inertial = std::move(states.inertial);
  });
}

// Tables that are no part of the format lie beside mav0.
path folder_of_tables(const path& folder, const path& mav) {
  const path whole = std::filesystem::absolute(mav).lexically_normal();
  const bool is_mav0 = mav != folder || whole.filename() == "mav0";
  return is_mav0 ? whole.parent_path() : folder;
}

}  // namespace

std::optional<Recording> find_euroc(const path& folder, const Config& config) {
  const bool is_around = is_folder(folder / "mav0");
  if (!is_around && !is_there(folder / "cam0" / "data.csv")) return std::nullopt;
  const path mav = is_around ? folder / "mav0" : folder;
  Recording recording{.format = "EuRoC"};
  const std::vector<StampedLine> rows = read_stamped_lines(mav / "cam0" / "data.csv");
  if (rows.empty()) throw InputError((mav / "cam0" / "data.csv").string() + ": lists no image");
  add_first_pictures(mav / "cam0", rows, recording);
  const bool is_stereo = is_folder(mav / "cam1");
  if (is_stereo) add_partners(mav / "cam1", config.max_stamp_difference_s, recording);
  const bool has_rig = read_own_rig(config, recording, [&] {
    add_camera(mav / "cam0" / "sensor.yaml", recording.rig);
    if (is_stereo) add_camera(mav / "cam1" / "sensor.yaml", recording.rig);
  });
  if (has_rig && is_folder(mav / "imu0")) read_imu(mav / "imu0", recording);
  recording.truth =
      read_truth(folder_of_tables(folder, mav), static_cast<int>(recording.frames.size()));
  const path truth = mav / "state_groundtruth_estimate0";
  if (is_folder(truth)) add_states(truth, has_rig, recording);
  return recording;
}

}  // namespace samewhere::input
