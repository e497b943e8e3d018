#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/input/file_names.hpp>
#include <samewhere/input/formats.hpp>
#include <samewhere/input/left_out.hpp>
#include <samewhere/input/list_file.hpp>
#include <samewhere/input/stamped_frames.hpp>
#include <samewhere/input/truth_file.hpp>

namespace samewhere::input {
namespace {

using core::InputError;
using std::filesystem::path;

constexpr double kDepthUnitsPerM = 5000.0;

std::string missing(const StampedFile& listed, const char* kind) {
  return fmt::format("{}: the {} image {} does not exist", listed.place, kind, listed.file.name);
}

// Pairs as associate.py writes them: a frame without its depth image has none.
std::vector<FrameFiles> read_pairs(const path& list, bool with_depth) {
  const std::vector<StampedPair> pairs = read_associations(list);
  if (pairs.empty()) throw InputError(list.string() + ": lists no image");
  std::vector<FrameFiles> frames;
  LeftOut left_out;
  for (const auto& [colour, depth] : pairs) {
    if (!colour.file.is_there) {
      left_out.add(missing(colour, "colour"));
      continue;
    }
    frames.push_back({colour.file.name, colour.stamp_s, {colour.file.path}});
    if (!with_depth) continue;
    if (depth.file.is_there) {
      frames.back().depth = depth.file.path;
    } else {
      left_out.add(missing(depth, "depth"));
    }
  }
  left_out.refuse_most(pairs.size(), "pairs of images");
  left_out.warn(pairs.size(), "pairs of images, or the depth of them,");
  return frames;
}

// The list of pairs of a folder; empty: there is none.
path associations_of(const path& folder) {
  for (const char* name :
       {"associations.txt", "associate.txt", "assoc.txt", "association.txt", "associated.txt"}) {
    if (is_there(folder / name)) return folder / name;
  }
  return {};
}

}  // namespace

std::optional<Recording> find_tum_rgbd(const path& folder, const Config& config) {
  const bool has_colour = is_there(folder / "rgb.txt");
  const bool has_depth = is_there(folder / "depth.txt");
  const path pairs = has_colour && has_depth ? path() : associations_of(folder);
  if (!has_colour && pairs.empty()) return std::nullopt;
  Recording recording{.format = "TUM RGB-D", .depth_units_per_m = kDepthUnitsPerM};
  if (!pairs.empty()) {
    recording.frames = read_pairs(pairs, config.depth);
  } else {
    recording.frames = read_stamped_frames(folder / "rgb.txt");
    if (config.depth && has_depth)
      attach_stamped_depth(folder / "depth.txt", config, recording.frames);
  }
  if (is_there(folder / "camera.txt")) recording.camera_file = folder / "camera.txt";
  recording.truth = read_truth(folder, static_cast<int>(recording.frames.size()));
  if (is_there(folder / "groundtruth.txt"))
    recording.truth.trajectory = read_true_trajectory(folder / "groundtruth.txt");
  return recording;
}

}  // namespace samewhere::input
