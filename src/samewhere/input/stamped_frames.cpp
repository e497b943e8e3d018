#include <algorithm>
#include <iterator>
#include <limits>
#include <string>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/input/associate.hpp>
#include <samewhere/input/left_out.hpp>
#include <samewhere/input/list_file.hpp>
#include <samewhere/input/stamped_frames.hpp>

namespace samewhere::input {
namespace {

using core::InputError;
using std::filesystem::path;

std::string listed_but_missing(const StampedFile& listed, const char* kind) {
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
        fmt::format("{}: lists no depth image, expected some near in time to the colour images; {}",
                    list.string(), kWayOut));
  }
  throw InputError(fmt::format(
      "{}: no depth image fits a colour image: the nearest two are {:.6g} s apart, expected "
      "at most {} s (input.max_stamp_difference_s); {}",
      list.string(), smallest_difference_s(colour_s, depth_s), max_difference_s, kWayOut));
}

}  // namespace

std::vector<FrameFiles> read_stamped_frames(const path& list) {
  const std::vector<StampedFile> listed = read_stamped_files(list);
  if (listed.empty()) throw InputError(list.string() + ": lists no image");
  std::vector<FrameFiles> frames;
  LeftOut left_out;
  for (const StampedFile& colour : listed) {
    if (colour.file.is_there) {
      frames.push_back({colour.file.name, colour.stamp_s, {colour.file.path}});
    } else {
      left_out.add(listed_but_missing(colour, "colour"));
    }
  }
  left_out.refuse_most(listed.size(), "colour images");
  left_out.warn(listed.size(), "colour images");
  return frames;
}

// Single images without depth are usual. If none has depth, the lists do not belong together, and a
// run without scale is not what the user of a depth camera expects.
void attach_stamped_depth(const path& list, const Config& config, std::vector<FrameFiles>& frames) {
  const double max_difference_s = config.max_stamp_difference_s;
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
      left_out.add(listed_but_missing(depth, "depth"));
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

}  // namespace samewhere::input
