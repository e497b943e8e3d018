#include <algorithm>
#include <string_view>

#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/text_file.hpp>
#include <samewhere/input/file_names.hpp>
#include <samewhere/input/formats.hpp>
#include <samewhere/input/left_out.hpp>
#include <samewhere/input/numbered.hpp>
#include <samewhere/input/truth_file.hpp>

namespace samewhere::input {
namespace {

using core::InputError;
using std::filesystem::path;

constexpr double kSevenScenesFps = 30.0;

bool is_colour_name(const std::string& name) {
  return name.starts_with("frame-") && is_image_name(name) &&
         path(name).stem().extension() == ".color";
}

// The file that belongs to frame-000012.color.png by its ending, .depth.png or .pose.txt.
path sibling(const FrameFiles& frame, std::string_view ending) {
  const path& image = frame.images.front();
  return image.parent_path() / (image.stem().stem().string() + std::string(ending));
}

core::Rigid3 read_pose(const path& file) {
  const std::vector<core::TextLine> lines = core::read_text_lines(file);
  if (lines.size() != 4) {
    throw InputError(fmt::format("{}: found {} rows, expected the 4 of a pose matrix",
                                 file.string(), lines.size()));
  }
  std::vector<double> rows;
  for (const core::TextLine& line : lines) {
    const std::vector<double> row = core::finite_numbers(line, 4, "a row of a pose matrix");
    rows.insert(rows.end(), row.begin(), row.end());
  }
  return rigid_from_rows({file.string(), {}}, rows);
}

// Empty if no frame has a pose file.
core::Trajectory read_poses(const std::vector<FrameFiles>& frames) {
  const auto has_pose = [](const FrameFiles& frame) {
    return is_there(sibling(frame, ".pose.txt"));
  };
  if (std::none_of(frames.begin(), frames.end(), has_pose)) return {};
  core::Trajectory trajectory;
  LeftOut left_out;
  for (const FrameFiles& frame : frames) {
    try {
      trajectory.push_back({frame.stamp_s, read_pose(sibling(frame, ".pose.txt"))});
    } catch (const InputError& error) {
      left_out.add(error.what());
    }
  }
  left_out.warn(frames.size(), "poses of the ground truth");
  return trajectory;
}

}  // namespace

std::optional<Recording> find_seven_scenes(const path& folder, const Config& config) {
  Recording recording{.format = "7-Scenes"};
  for (const std::string& name : sorted_names(folder)) {
    if (is_colour_name(name)) recording.frames.push_back({name, 0.0, {folder / name}});
  }
  if (recording.frames.empty()) return std::nullopt;
  stamp_by_number(recording.frames, config.fps > 0.0 ? config.fps : kSevenScenesFps);
  std::vector<path> depths;
  for (const FrameFiles& frame : recording.frames) depths.push_back(sibling(frame, ".depth.png"));
  // a sequence may come without depth
  if (config.depth && std::any_of(depths.begin(), depths.end(), &is_there))
    attach_depth(recording.frames, depths);
  if (is_there(folder / "camera.txt")) recording.camera_file = folder / "camera.txt";
  recording.truth = read_truth(folder, static_cast<int>(recording.frames.size()));
  core::Trajectory poses = read_poses(recording.frames);
  if (!poses.empty()) recording.truth.trajectory = std::move(poses);
  return recording;
}

}  // namespace samewhere::input
