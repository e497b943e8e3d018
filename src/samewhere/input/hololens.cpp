#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/text_file.hpp>
#include <samewhere/input/depth_folder.hpp>
#include <samewhere/input/file_names.hpp>
#include <samewhere/input/formats.hpp>
#include <samewhere/input/numbered.hpp>
#include <samewhere/input/truth_file.hpp>

namespace samewhere::input {
namespace {

using core::InputError;
using std::filesystem::path;

constexpr double kHololensFps = 12.0;

core::Rigid3 pose_of(const core::TextLine& line) {
  return rigid_from_rows(line, core::finite_numbers(line, 16, "a pose matrix, row by row"));
}

}  // namespace

std::optional<Recording> find_hololens(const path& folder, const Config& config) {
  if (!is_folder(folder / "images")) return std::nullopt;
  const bool has_its_files = is_there(folder / "K.txt") || is_there(folder / "poses.txt");
  const bool has_depth_alone = is_folder(folder / "depth") && !is_there(folder / "camera.txt");
  if (!has_its_files && !has_depth_alone) return std::nullopt;
  Recording recording{.format = "HoloLens"};
  for (const std::string& name : picture_names(folder / "images"))
    recording.frames.push_back({name, 0.0, {folder / "images" / name}});
  if (recording.frames.empty()) {
    throw InputError((folder / "images").string() + ": holds no .jpg, .jpeg or .png image");
  }
  stamp_by_number(recording.frames, config.fps > 0.0 ? config.fps : kHololensFps);
  if (config.depth && is_folder(folder / "depth"))
    attach_depth_folder(folder / "depth", config.max_stamp_difference_s, recording.frames);
  if (is_there(folder / "K.txt")) recording.camera_file = folder / "K.txt";
  recording.truth = read_truth(folder, static_cast<int>(recording.frames.size()));
  if (is_there(folder / "poses.txt")) {
    recording.truth.trajectory = read_pose_lines(folder / "poses.txt", recording.frames, &pose_of);
  }
  return recording;
}

}  // namespace samewhere::input
