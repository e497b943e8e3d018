#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/text_file.hpp>
#include <samewhere/input/file_names.hpp>
#include <samewhere/input/formats.hpp>
#include <samewhere/input/numbered.hpp>
#include <samewhere/input/truth_file.hpp>

namespace samewhere::input {
namespace {

using core::InputError;
using std::filesystem::path;

constexpr double kHololensFps = 12.0;

// poses.txt: one pose a line, in the order of the frames.
core::Trajectory read_poses(const path& file, const std::vector<FrameFiles>& frames) {
  const std::vector<core::TextLine> lines = core::read_text_lines(file);
  core::Trajectory trajectory;
  for (const core::TextLine& line : lines) {
    const std::vector<double> rows = core::finite_numbers(line, 16, "a pose matrix, row by row");
    if (trajectory.size() == frames.size()) break;
    trajectory.push_back({frames[trajectory.size()].stamp_s, rigid_from_rows(line, rows)});
  }
  if (lines.size() != frames.size()) {
    throw InputError(fmt::format("{}: found {} poses, expected {}, one per image", file.string(),
                                 lines.size(), frames.size()));
  }
  return trajectory;
}

}  // namespace

std::optional<Recording> find_hololens(const path& folder, const Config& config) {
  const bool is_here =
      is_folder(folder / "images") &&
      (is_there(folder / "K.txt") || is_there(folder / "poses.txt") || is_folder(folder / "depth"));
  if (!is_here) return std::nullopt;
  Recording recording{.format = "HoloLens"};
  std::vector<path> depths;
  for (const std::string& name : sorted_names(folder / "images")) {
    if (!is_image_name(name)) continue;
    recording.frames.push_back({name, 0.0, {folder / "images" / name}});
    depths.push_back(folder / "depth" / path(name).replace_extension(".png"));
  }
  if (recording.frames.empty()) {
    throw InputError((folder / "images").string() + ": holds no .jpg, .jpeg or .png image");
  }
  stamp_by_number(recording.frames, config.fps > 0.0 ? config.fps : kHololensFps);
  if (is_folder(folder / "depth")) attach_depth(recording.frames, depths);
  if (is_there(folder / "K.txt")) recording.camera_file = folder / "K.txt";
  recording.truth = read_truth(folder, static_cast<int>(recording.frames.size()));
  if (is_there(folder / "poses.txt")) {
    recording.truth.trajectory = read_poses(folder / "poses.txt", recording.frames);
  }
  return recording;
}

}  // namespace samewhere::input
