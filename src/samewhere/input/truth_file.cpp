#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <sstream>
#include <string>

#include <Eigen/LU>
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/core/tum_file.hpp>
#include <samewhere/input/csv_file.hpp>
#include <samewhere/input/file_names.hpp>
#include <samewhere/input/left_out.hpp>
#include <samewhere/input/truth_file.hpp>

namespace samewhere::input {
namespace {

using core::InputError;
using core::PlaceTruthMatrix;
using std::filesystem::path;

// The next whole number of a PGM header; '#' comments run to the end of their line.
int header_number(std::istream& in, const path& file) {
  while ((in >> std::ws).peek() == '#')
    in.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
  int number = 0;
  if (in >> number && number > 0) return number;
  throw InputError(file.string() + ": the header is broken, expected P5, width, height, maximum");
}

PlaceTruthMatrix read_pgm(const path& file, int num_frames) {
  constexpr std::uint64_t kMaxHeader = 1000;
  const std::uint64_t num_pairs = std::uint64_t(num_frames) * std::uint64_t(num_frames);
  const core::SizeLimit limit{std::max(num_pairs + kMaxHeader, core::kTextLimit.num_bytes),
                              "a matrix of frames"};
  std::istringstream in(core::read_file(file, limit));
  if (in.get() != 'P' || in.get() != '5') {
    throw InputError(file.string() + ": is not a binary PGM file (P5)");
  }
  const int width = header_number(in, file);
  const int height = header_number(in, file);
  const int maximum = header_number(in, file);
  in.get();  // one white space ends the header
  if (width != num_frames || height != num_frames || maximum > 255) {
    throw InputError(
        fmt::format("{}: is {} x {} with values up to {}, expected {} x {} (one row and column per "
                    "frame) in 8 bits",
                    file.string(), width, height, maximum, num_frames, num_frames));
  }
  const std::string values{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  const auto num_values = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  if (values.size() != num_values) {
    throw InputError(
        fmt::format("{}: holds {} values, expected {}", file.string(), values.size(), num_values));
  }
  PlaceTruthMatrix places{num_frames, {}};
  places.values.reserve(num_values);
  for (const char value : values) {
    places.values.push_back(place_truth_of_value(static_cast<unsigned char>(value), file.string()));
  }
  return places;
}

PlaceTruthMatrix read_text_matrix(const path& file, int num_frames) {
  const std::vector<core::TextLine> lines = core::read_text_lines(file);
  if (lines.size() != static_cast<std::size_t>(num_frames)) {
    throw InputError(fmt::format("{}: has {} rows, expected {}, one per frame", file.string(),
                                 lines.size(), num_frames));
  }
  PlaceTruthMatrix places{num_frames, {}};
  for (const core::TextLine& line : lines) {
    if (line.words.size() != lines.size()) {
      throw InputError(fmt::format("{}: has {} columns, expected {}, one per frame", line.place,
                                   line.words.size(), lines.size()));
    }
    for (std::size_t column = 0; column < line.words.size(); ++column) {
      places.values.push_back(place_truth_of_value(core::finite_number(line, column), line.place));
    }
  }
  return places;
}

}  // namespace

namespace {

// query,match,...: aliased pairs, frames of different places with similar appearance.
std::vector<core::FramePair> read_aliased_pairs(const path& file, int num_frames) {
  const std::vector<core::TextLine> lines = read_csv_lines(file);
  std::vector<core::FramePair> pairs;
  for (std::size_t i = 1; i < lines.size(); ++i) {  // the first names the columns
    if (lines[i].words.size() < 2) {
      throw InputError(lines[i].place + ": one column; expected query,match,...");
    }
    const double query = core::finite_number(lines[i], 0);
    const double match = core::finite_number(lines[i], 1);
    const bool is_pair = query == std::floor(query) && match == std::floor(match) && match >= 0 &&
                         match < query && query < num_frames;
    if (!is_pair) {
      throw InputError(fmt::format("{}: {},{}; expected query > match >= 0, frames below {}",
                                   lines[i].place, query, match, num_frames));
    }
    pairs.push_back({static_cast<int>(query), static_cast<int>(match)});
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

// Puts poses in the order of their stamps and leaves out those whose stamp an earlier one has.
// `places` are the lines they come from, for messages.
core::Trajectory in_order(core::Trajectory poses, const std::vector<std::string>& places,
                          LeftOut& left_out) {
  std::vector<std::size_t> order(poses.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&poses](std::size_t a, std::size_t b) {
    return poses[a].stamp_s < poses[b].stamp_s;
  });
  core::Trajectory sorted;
  for (const std::size_t i : order) {
    if (sorted.empty() || poses[i].stamp_s > sorted.back().stamp_s) {
      sorted.push_back(poses[i]);
    } else {
      left_out.add(fmt::format("{}: found stamp {:.6f} a second time, expected it once", places[i],
                               poses[i].stamp_s));
    }
  }
  return sorted;
}

}  // namespace

core::PlaceTruth place_truth_of_value(double value, const std::string& place) {
  if (value == 0.0 || value == 1.0 || value == 2.0) return static_cast<core::PlaceTruth>(value);
  throw InputError(fmt::format(
      "{}: found the value {}, expected 0 (different), 1 (same) or 2 (near)", place, value));
}

bool read_if_sound(const char* consequence, const std::function<void()>& read) {
  try {
    read();
    return true;
  } catch (const InputError& error) {
    spdlog::warn("{}; {}", error.what(), consequence);
    return false;
  }
}

core::Trajectory read_true_trajectory(const path& file) {
  return read_true_trajectory(file, {core::read_text_lines, core::tum_pose});
}

core::Trajectory read_true_trajectory(const path& file, const TrajectoryFormat& format) {
  core::Trajectory trajectory;
  read_if_sound("the run goes on without this ground truth", [&] {
    std::vector<core::TextLine> lines = format.read_lines(file);
    core::drop_column_names(lines);
    core::Trajectory poses;
    std::vector<std::string> places;
    LeftOut left_out;
    for (const core::TextLine& line : lines) {
      try {
        poses.push_back(format.pose_of(line));
        places.push_back(line.place);
      } catch (const InputError& error) {
        left_out.add(error.what());
      }
    }
    trajectory = in_order(std::move(poses), places, left_out);
    left_out.warn(lines.size(), "poses of the ground truth");
  });
  return trajectory;
}

core::Truth read_truth(const path& folder, int num_frames) {
  constexpr const char* kWithout = "the run goes on without it";
  core::Truth truth;
  if (is_there(folder / "groundtruth.tum"))
    truth.trajectory = read_true_trajectory(folder / "groundtruth.tum");
  if (is_there(folder / kSamePlaceTable)) {
    read_if_sound(kWithout, [&] { truth.places = read_pgm(folder / kSamePlaceTable, num_frames); });
  } else if (is_there(folder / "same_place.txt")) {
    read_if_sound(kWithout,
                  [&] { truth.places = read_text_matrix(folder / "same_place.txt", num_frames); });
  }
  if (is_there(folder / "aliased_pairs.csv")) {
    read_if_sound(kWithout, [&] {
      truth.aliased_pairs = read_aliased_pairs(folder / "aliased_pairs.csv", num_frames);
    });
  }
  return truth;
}

core::Rigid3 rigid_from_rows(const core::TextLine& line, const std::vector<double>& rows) {
  core::require(rows.size() == 16, "a pose matrix has 16 numbers");
  const Eigen::Matrix4d world_from_camera =
      Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(rows.data());
  const Eigen::Matrix3d rotation = world_from_camera.topLeftCorner<3, 3>();
  // files round: 1e-2 passes three decimals and catches a matrix that scales or mirrors
  constexpr double kMaxRounding = 1e-2;
  const bool is_rotation =
      (rotation.transpose() * rotation - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() <
          kMaxRounding &&
      rotation.determinant() > 0.0;
  if (!is_rotation || world_from_camera.row(3) != Eigen::RowVector4d(0.0, 0.0, 0.0, 1.0)) {
    throw InputError(line.place +
                     ": is no rigid transform, expected a rotation, a translation and 0 0 0 1");
  }
  return core::Rigid3::from_matrix(world_from_camera);
}

}  // namespace samewhere::input
