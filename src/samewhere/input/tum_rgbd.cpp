#include <algorithm>
#include <iterator>
#include <limits>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/text_file.hpp>
#include <samewhere/core/tum_file.hpp>
#include <samewhere/input/associate.hpp>
#include <samewhere/input/file_names.hpp>
#include <samewhere/input/formats.hpp>
#include <samewhere/input/truth_file.hpp>

namespace samewhere::input {
namespace {

using core::InputError;
using std::filesystem::path;

constexpr double kDepthUnitsPerM = 5000.0;

struct StampedName {
  std::string place;  // of its line, for messages
  double stamp_s = 0.0;
  std::string name;
};

// rgb.txt or depth.txt.
std::vector<StampedName> read_stamped_names(const path& list) {
  std::vector<StampedName> names;
  for (const core::TextLine& line : core::read_text_lines(list)) {
    if (line.words.size() < 2) {
      throw InputError(line.place + ": found one word, expected 'stamp filename'");
    }
    const double stamp_s = core::finite_number(line, 0);
    if (!names.empty() && stamp_s <= names.back().stamp_s) {
      throw InputError(fmt::format("{}: found stamp {:.6f} after {:.6f}, expected stamps that rise",
                                   line.place, stamp_s, names.back().stamp_s));
    }
    names.push_back({line.place, stamp_s, line.words[1]});
  }
  return names;
}

path existing(const path& folder, const StampedName& file, const char* kind) {
  path image = folder / file.name;
  if (is_there(image)) return image;
  throw InputError(fmt::format("{}: the {} image {} does not exist", file.place, kind, file.name));
}

std::vector<double> stamps_of(const std::vector<StampedName>& files) {
  std::vector<double> stamps_s;
  for (const StampedName& file : files) stamps_s.push_back(file.stamp_s);
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

// Pictures here and there without depth are usual. If none has any, the lists do not belong
// together, and a run without scale is not what somebody with a depth camera expects.
void attach_depth(const path& folder, double max_difference_s, std::vector<FrameFiles>& frames) {
  const path list = folder / "depth.txt";
  const std::vector<StampedName> depths = read_stamped_names(list);
  std::vector<double> stamps_s;
  for (const FrameFiles& frame : frames) stamps_s.push_back(frame.stamp_s);
  const auto partners = associate(stamps_s, stamps_of(depths), max_difference_s);
  std::size_t num_found = 0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (!partners[i]) continue;
    frames[i].depth = existing(folder, depths[*partners[i]], "depth");
    ++num_found;
  }
  if (num_found == 0) fail_without_partners(list, stamps_s, stamps_of(depths), max_difference_s);
  if (2 * num_found < frames.size()) {
    spdlog::warn("{}: only {} of {} pictures have a depth image within {} s", list.string(),
                 num_found, frames.size(), max_difference_s);
  }
}

}  // namespace

std::optional<Recording> find_tum_rgbd(const path& folder, const Config& config) {
  if (!is_there(folder / "rgb.txt")) return std::nullopt;
  Recording recording{.format = "TUM RGB-D", .depth_units_per_m = kDepthUnitsPerM};
  for (const StampedName& file : read_stamped_names(folder / "rgb.txt")) {
    recording.frames.push_back({file.name, file.stamp_s, {existing(folder, file, "colour")}});
  }
  if (recording.frames.empty()) {
    throw InputError((folder / "rgb.txt").string() + ": lists no image");
  }
  if (config.depth && is_there(folder / "depth.txt")) {
    attach_depth(folder, config.max_stamp_difference_s, recording.frames);
  }
  if (is_there(folder / "camera.txt")) recording.camera_file = folder / "camera.txt";
  recording.truth = read_truth(folder, static_cast<int>(recording.frames.size()));
  if (is_there(folder / "groundtruth.txt")) {
    recording.truth.trajectory = core::read_tum(folder / "groundtruth.txt");
  }
  return recording;
}

}  // namespace samewhere::input
