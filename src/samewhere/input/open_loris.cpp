#include <map>
#include <queue>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/input/calibration.hpp>
#include <samewhere/input/file_names.hpp>
#include <samewhere/input/formats.hpp>
#include <samewhere/input/stamped_frames.hpp>
#include <samewhere/input/truth_file.hpp>
#include <samewhere/input/yaml_keys.hpp>

namespace samewhere::input {
namespace {

using core::InputError;
using core::Rigid3;
using std::filesystem::path;

constexpr const char* kColourFrame = "d400_color_optical_frame";
constexpr const char* kTruthFrame = "base_link";

YamlKeys keys_of(const path& file) {
  return {file, core::read_text(file, core::kCalibrationLimit)};
}

// Intrinsics stand in the order fx cx fy cy.
core::Camera read_colour_camera(const path& file) {
  const YamlKeys all = keys_of(file);
  if (!all.has_map(kColourFrame))
    throw InputError(fmt::format("{}: has no {}", file.string(), kColourFrame));
  const YamlKeys keys = all.below(kColourFrame);
  const std::vector<double> k = keys.numbers("intrinsics");
  if (k.size() != 4) {
    throw InputError(fmt::format("{}: found {} values, expected fx cx fy cy",
                                 keys.line("intrinsics").place, k.size()));
  }
  Calibration calibration{.place = file.string(),
                          .size_px = {keys.pixels("width"), keys.pixels("height")},
                          .fx_px = k[0],
                          .fy_px = k[2],
                          .cx_px = k[1],
                          .cy_px = k[3]};
  if (keys.has("distortion_coefficients")) {
    calibration.distortion = keys.numbers("distortion_coefficients");
    if (keys.has("distortion_model")) {
      const std::string model = keys.word("distortion_model");
      calibration.is_fisheye = is_fisheye_model(keys.line("distortion_model").place, model);
    }
  }
  return camera_of(calibration);
}

struct Link {
  std::string other;
  Rigid3 this_from_other;
};

std::map<std::string, std::vector<Link>> read_links(const path& file) {
  std::map<std::string, std::vector<Link>> links;
  for (const YamlKeys& keys : keys_of(file).maps("trans_matrix")) {
    const std::string parent = keys.word("parent_frame");
    const std::string child = keys.word("child_frame");
    const core::TextLine line = keys.line("matrix");
    const Rigid3 parent_from_child =
        rigid_from_rows(line, core::finite_numbers(line, 16, "a 4 x 4 matrix, row by row"));
    links[parent].push_back({child, parent_from_child});
    links[child].push_back({parent, inverse(parent_from_child)});
  }
  return links;
}

// Along the tree of frames.
Rigid3 base_from_colour(const path& file) {
  const auto links = read_links(file);
  std::map<std::string, Rigid3> base_from{{kTruthFrame, Rigid3{}}};
  std::queue<std::string> next({kTruthFrame});
  for (; !next.empty(); next.pop()) {
    const auto from_here = links.find(next.front());
    if (from_here == links.end()) continue;
    for (const Link& link : from_here->second) {
      const Rigid3 base_from_other = base_from.at(next.front()) * link.this_from_other;
      if (base_from.try_emplace(link.other, base_from_other).second) next.push(link.other);
    }
  }
  const auto colour = base_from.find(kColourFrame);
  if (colour != base_from.end()) return colour->second;
  throw InputError(
      fmt::format("{}: leads from {} to no {}", file.string(), kTruthFrame, kColourFrame));
}

core::Trajectory read_colour_trajectory(const path& folder) {
  core::Trajectory trajectory = read_true_trajectory(folder / "groundtruth.txt");
  const bool is_known = read_if_sound("the run goes on without ground truth", [&] {
    const Rigid3 base_from_camera = base_from_colour(folder / "trans_matrix.yaml");
    for (core::StampedPose& pose : trajectory)
      pose.world_from_camera = pose.world_from_camera * base_from_camera;
  });
  return is_known ? trajectory : core::Trajectory{};
}

}  // namespace

std::optional<Recording> find_open_loris(const path& folder, const Config& config) {
  if (!is_there(folder / "color.txt")) return std::nullopt;
  const bool has_depth = is_there(folder / "aligned_depth.txt");
  if (!has_depth && !is_there(folder / "sensors.yaml")) return std::nullopt;
  Recording recording{.format = "OpenLORIS-Scene"};
  recording.frames = read_stamped_frames(folder / "color.txt");
  if (config.depth && has_depth)
    attach_stamped_depth(folder / "aligned_depth.txt", config, recording.frames);
  if (is_there(folder / "camera.txt")) {
    recording.camera_file = folder / "camera.txt";
  } else if (is_there(folder / "sensors.yaml")) {
    read_own_rig(config, recording, [&] {
      recording.rig.cameras = {read_colour_camera(folder / "sensors.yaml")};
      recording.rig.body_from_camera = {Rigid3{}};
    });
  }
  recording.truth = read_truth(folder, static_cast<int>(recording.frames.size()));
  if (is_there(folder / "groundtruth.txt"))
    recording.truth.trajectory = read_colour_trajectory(folder);
  return recording;
}

}  // namespace samewhere::input
