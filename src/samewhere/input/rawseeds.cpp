#include <algorithm>
#include <charconv>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/text_file.hpp>
#include <samewhere/input/csv_file.hpp>
#include <samewhere/input/file_names.hpp>
#include <samewhere/input/formats.hpp>
#include <samewhere/input/left_out.hpp>
#include <samewhere/input/truth_file.hpp>

namespace samewhere::input {
namespace {

using core::InputError;
using core::Rigid3;
using std::filesystem::path;

constexpr std::string_view kPrefix = "FRONTAL_";

// FRONTAL_1235604664.906455.png
std::optional<double> stamp_of(std::string_view name) {
  if (!name.starts_with(kPrefix)) return std::nullopt;
  const std::string_view digits = name.substr(kPrefix.size(), name.rfind('.') - kPrefix.size());
  double stamp_s = 0.0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), stamp_s);
  const bool is_number = error == std::errc{} && end == digits.data() + digits.size();
  return is_number && std::isfinite(stamp_s) ? std::optional(stamp_s) : std::nullopt;
}

std::vector<FrameFiles> read_frontal(const path& folder) {
  std::vector<FrameFiles> frames;
  LeftOut left_out;
  const std::vector<std::string> names = picture_names(folder);
  for (const std::string& name : names) {
    if (const auto stamp_s = stamp_of(name)) {
      frames.push_back({name, *stamp_s, {folder / name}});
    } else {
      left_out.add(fmt::format("{}: has no stamp, expected FRONTAL_<seconds>.png",
                               (folder / name).string()));
    }
  }
  left_out.refuse_most(names.size(), "images");
  left_out.warn(names.size(), "images");
  std::sort(frames.begin(), frames.end(),
            [](const FrameFiles& a, const FrameFiles& b) { return a.stamp_s < b.stamp_s; });
  const auto twice = std::adjacent_find(
      frames.begin(), frames.end(),
      [](const FrameFiles& a, const FrameFiles& b) { return a.stamp_s == b.stamp_s; });
  if (twice == frames.end()) return frames;
  throw InputError(fmt::format("{}: has the stamp of another image, {:.6f} s",
                               twice->images.front().string(), twice->stamp_s));
}

// The first that is there; empty: none is.
path truth_of(const path& folder) {
  for (const char* const ending : {"-GROUNDTRUTH.csv", "-GT-extended.csv"}) {
    for (const std::string& name : sorted_names(folder)) {
      if (name.ends_with(ending)) return folder / name;
    }
  }
  return {};
}

// Of the frontal camera of Bicocca on the robot, whose x axis points forward and z up.
Rigid3 robot_from_frontal() {
  Eigen::Matrix4d matrix;
  matrix << 0, 0, 1, -0.171,  //
      -1, 0, 0, -0.115,       //
      0, -1, 0, 1.068,        //
      0, 0, 0, 1;
  return Rigid3::from_matrix(matrix);
}

// stamp, x, y, theta (s, m, rad); what follows is the covariance.
core::StampedPose pose_of(const core::TextLine& line) {
  if (line.words.size() < 4)
    throw InputError(fmt::format("{}: found {} columns, expected stamp, x, y, theta", line.place,
                                 line.words.size()));
  const double theta_rad = core::finite_number(line, 3);
  const Rigid3 world_from_robot{core::exp_so3({0.0, 0.0, theta_rad}),
                                {core::finite_number(line, 1), core::finite_number(line, 2), 0.0}};
  return {core::finite_number(line, 0), world_from_robot * robot_from_frontal()};
}

}  // namespace

std::optional<Recording> find_rawseeds(const path& folder, const Config& /*config*/) {
  if (!is_folder(folder / "FRONTAL")) return std::nullopt;
  Recording recording{.format = "Rawseeds", .frames = read_frontal(folder / "FRONTAL")};
  if (recording.frames.empty())
    throw InputError((folder / "FRONTAL").string() + ": holds no FRONTAL_<seconds>.png");
  if (is_there(folder / "camera.txt")) recording.camera_file = folder / "camera.txt";
  recording.truth = read_truth(folder, static_cast<int>(recording.frames.size()));
  if (const path truth = truth_of(folder); !truth.empty())
    recording.truth.trajectory = read_true_trajectory(truth, {read_csv_lines, pose_of});
  return recording;
}

}  // namespace samewhere::input
