#include <algorithm>
#include <cstdlib>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/input/file_names.hpp>
#include <samewhere/input/formats.hpp>
#include <samewhere/input/left_out.hpp>
#include <samewhere/input/name_stamps.hpp>
#include <samewhere/input/place_matrix.hpp>
#include <samewhere/input/truth_file.hpp>

namespace samewhere::input {
namespace {

using core::InputError;
using std::filesystem::path;

constexpr double kSetFps = 1.0;          // Lip6; New College and City Centre have no times
constexpr double kTraverseFps = 30.0;    // GardensPoint: no times either
constexpr int kNearTraverse_frames = 8;  // GTsoft of the VPR tutorial: 17 frames about the true one

// Where the pictures of a set lie; empty: nowhere.
path pictures_of_set(const path& folder) {
  for (const char* const name : {"Images", "images"}) {
    if (is_folder(folder / name) && !picture_names(folder / name).empty()) return folder / name;
  }
  return picture_names(folder).empty() ? path() : folder;
}

bool has_files_of_fab_map(const path& folder) {
  for (const path& place : {folder, folder / "masks"}) {
    if (!is_folder(place)) continue;
    for (const std::string& name : sorted_names(place)) {
      if (name.starts_with("ImageCollectionCoordinates") || name.starts_with("NewCollege") ||
          name.starts_with("CityCent"))
        return true;
    }
  }
  return false;
}

// Nothing: it is none of the known sets.
std::optional<std::string> format_of_set(const path& folder, const std::string& first_picture) {
  if (first_picture.starts_with("lip6kennedy") || first_picture.starts_with("outdoor_kennedylong"))
    return "Lip6";
  if (has_files_of_fab_map(folder)) return "FAB-MAP";
  return std::nullopt;
}

struct Traverse {
  std::vector<FrameFiles> frames;
  std::vector<int> numbers;  // in the names: the same place in each traverse
};

void read_traverse(const path& folder, Traverse& all) {
  LeftOut left_out;
  const std::vector<std::string> names = picture_names(folder);
  for (const std::string& name : names) {
    if (const auto number = frame_number(name)) {
      all.frames.push_back({folder.filename().string() + "/" + name, 0.0, {folder / name}});
      all.numbers.push_back(*number);
    } else {
      left_out.add(
          fmt::format("{}: has no number, expected Image000.jpg", (folder / name).string()));
    }
  }
  left_out.refuse_most(names.size(), "images");
  left_out.warn(names.size(), "images");
}

core::PlaceTruth place_of(int difference_frames, int tolerance_frames) {
  if (difference_frames <= tolerance_frames) return core::PlaceTruth::kSame;
  return difference_frames <= kNearTraverse_frames ? core::PlaceTruth::kNear
                                                   : core::PlaceTruth::kDifferent;
}

core::PlaceTruthMatrix places_of(const std::vector<int>& numbers, int tolerance_frames) {
  core::PlaceTruthMatrix places{static_cast<int>(numbers.size()), {}};
  places.values.reserve(numbers.size() * numbers.size());
  for (const int query : numbers) {
    for (const int match : numbers)
      places.values.push_back(place_of(std::abs(query - match), tolerance_frames));
  }
  return places;
}

}  // namespace

std::optional<Recording> find_place_set(const path& folder, const Config& config) {
  const path pictures = pictures_of_set(folder);
  if (pictures.empty()) return std::nullopt;
  const std::vector<std::string> names = picture_names(pictures);
  const auto format = format_of_set(folder, names.front());
  if (!format) return std::nullopt;
  Recording recording{.format = *format};
  const double fps = config.fps > 0.0 ? config.fps : kSetFps;
  const NameStamps stamps = stamps_from_names(names, fps, true);
  if (!stamps.remark.empty()) spdlog::warn("{}: {}", pictures.string(), stamps.remark);
  for (std::size_t i = 0; i < names.size(); ++i)
    recording.frames.push_back({names[i], stamps.stamps_s[i], {pictures / names[i]}});
  if (is_there(folder / "camera.txt")) recording.camera_file = folder / "camera.txt";
  recording.truth = read_truth(folder, static_cast<int>(recording.frames.size()));
  return recording;
}

std::optional<Recording> find_gardens_point(const path& folder, const Config& config) {
  Traverse all;
  int num_traverses = 0;
  for (const char* const name : kTraverses) {
    if (!is_folder(folder / name)) continue;
    read_traverse(folder / name, all);
    ++num_traverses;
  }
  if (num_traverses < 2 || all.frames.empty()) return std::nullopt;
  if (all.frames.size() > static_cast<std::size_t>(kMaxPlaceRows)) {
    throw InputError(fmt::format("{}: holds {} images, expected at most {}", folder.string(),
                                 all.frames.size(), kMaxPlaceRows));
  }
  Recording recording{.format = "GardensPoint", .frames = std::move(all.frames)};
  const double fps = config.fps > 0.0 ? config.fps : kTraverseFps;
  for (std::size_t i = 0; i < recording.frames.size(); ++i)
    recording.frames[i].stamp_s = static_cast<double>(i) / fps;
  if (is_there(folder / "camera.txt")) recording.camera_file = folder / "camera.txt";
  recording.truth = read_truth(folder, static_cast<int>(recording.frames.size()));
  if (!recording.truth.places) {
    recording.truth.places = places_of(all.numbers, std::max(0, config.truth_tolerance_frames));
    recording.is_place_truth_final = true;
  }
  return recording;
}

}  // namespace samewhere::input
