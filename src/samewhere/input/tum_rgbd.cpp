#include <fmt/format.h>

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

void attach_depth(const path& folder, double max_difference_s, std::vector<FrameFiles>& frames) {
  const std::vector<StampedName> depths = read_stamped_names(folder / "depth.txt");
  std::vector<double> stamps_s;
  for (const FrameFiles& frame : frames) stamps_s.push_back(frame.stamp_s);
  const auto partners = associate(stamps_s, stamps_of(depths), max_difference_s);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (partners[i]) frames[i].depth = existing(folder, depths[*partners[i]], "depth");
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
  if (is_there(folder / "depth.txt")) {
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
