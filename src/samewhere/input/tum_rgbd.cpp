#include <algorithm>
#include <iterator>
#include <limits>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/input/associate.hpp>
#include <samewhere/input/file_names.hpp>
#include <samewhere/input/formats.hpp>
#include <samewhere/input/left_out.hpp>
#include <samewhere/input/list_file.hpp>
#include <samewhere/input/truth_file.hpp>

namespace samewhere::input {
namespace {

using core::InputError;
using std::filesystem::path;

constexpr double kDepthUnitsPerM = 5000.0;

std::string missing(const StampedFile& listed, const char* kind) {
  return fmt::format("{}: the {} image {} does not exist", listed.place, kind, listed.file.name);
}

std::vector<double> stamps_of(const std::vector<StampedFile>& files) {
  std::vector<double> stamps_s;
  for (const StampedFile& file : files) stamps_s.push_back(file.stamp_s);
  return stamps_s;
}

// Between a stamp of one list and one of the other; both rise and hold one at least.
double smallest_difference_s(const std::vector<double>& a_s, const std::vector<double>& b_s) {
  double smallest_s = std::numeric_limits<double>::infinity();
  for (const double stamp_s : a_s) {
    const auto after = std::lower_bound(b_s.begin(), b_s.end(), stamp_s);
    if (after != b_s.end()) smallest_s = std::min(smallest_s, *after - stamp_s);
    if (after != b_s.begin()) smallest_s = std::min(smallest_s, stamp_s - *std::prev(after));
  }
  return smallest_s;
}

[[noreturn]] void fail_without_partners(const path& list, const std::vector<double>& colour_s,
                                        const std::vector<double>& depth_s,
                                        double max_difference_s) {
  constexpr const char* kWayOut = "--set input.depth=false runs without depth";
  if (depth_s.empty()) {
    throw InputError(
        fmt::format("{}: lists no depth image, expected some near in time to those of rgb.txt; {}",
                    list.string(), kWayOut));
  }
  throw InputError(fmt::format(
      "{}: no depth image fits a picture of rgb.txt: the nearest two are {:.6g} s apart, expected "
      "at most {} s (input.max_stamp_difference_s); {}",
      list.string(), smallest_difference_s(colour_s, depth_s), max_difference_s, kWayOut));
}

// Single images without depth are usual. If none has depth, the lists do not belong together, and a
// run without scale is not what the user of a depth camera expects.
void attach_depth(const path& folder, double max_difference_s, std::vector<FrameFiles>& frames) {
  const path list = folder / "depth.txt";
  const std::vector<StampedFile> depths = read_stamped_files(list);
  std::vector<double> stamps_s;
  for (const FrameFiles& frame : frames) stamps_s.push_back(frame.stamp_s);
  const auto partners = associate(stamps_s, stamps_of(depths), max_difference_s);
  LeftOut left_out;
  std::size_t num_partners = 0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (!partners[i]) continue;
    ++num_partners;
    const StampedFile& depth = depths[*partners[i]];
    if (depth.file.is_there) {
      frames[i].depth = depth.file.path;
    } else {
      left_out.add(missing(depth, "depth"));
    }
  }
  if (num_partners == 0) fail_without_partners(list, stamps_s, stamps_of(depths), max_difference_s);
  left_out.refuse_most(num_partners, "depth images");
  left_out.warn(num_partners, "depth images");
  if (2 * num_partners < frames.size()) {
    spdlog::warn("{}: only {} of {} pictures have a depth image within {} s", list.string(),
                 num_partners, frames.size(), max_difference_s);
  }
}

std::vector<FrameFiles> read_colour(const path& list) {
  const std::vector<StampedFile> listed = read_stamped_files(list);
  if (listed.empty()) throw InputError(list.string() + ": lists no image");
  std::vector<FrameFiles> frames;
  LeftOut left_out;
  for (const StampedFile& colour : listed) {
    if (colour.file.is_there) {
      frames.push_back({colour.file.name, colour.stamp_s, {colour.file.path}});
    } else {
      left_out.add(missing(colour, "colour"));
    }
  }
  left_out.refuse_most(listed.size(), "colour images");
  left_out.warn(listed.size(), "colour images");
  return frames;
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
    recording.frames = read_colour(folder / "rgb.txt");
    if (config.depth && has_depth)
      attach_depth(folder, config.max_stamp_difference_s, recording.frames);
  }
  if (is_there(folder / "camera.txt")) recording.camera_file = folder / "camera.txt";
  recording.truth = read_truth(folder, static_cast<int>(recording.frames.size()));
  if (is_there(folder / "groundtruth.txt"))
    recording.truth.trajectory = read_true_trajectory(folder / "groundtruth.txt");
  return recording;
}

}  // namespace samewhere::input
