#include <functional>
#include <map>
#include <optional>
#include <string>

#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/input/associate.hpp>
#include <samewhere/input/depth_folder.hpp>
#include <samewhere/input/file_names.hpp>
#include <samewhere/input/left_out.hpp>
#include <samewhere/input/name_stamps.hpp>

namespace samewhere::input {
namespace {

using std::filesystem::path;
using Names = std::vector<std::string>;

// For each picture the index of its depth image.
using Partners = std::vector<std::optional<std::size_t>>;

std::size_t num_found(const Partners& partners) {
  std::size_t count = 0;
  for (const auto& partner : partners) count += partner ? 1U : 0U;
  return count;
}

// Those with the same key; empty keys have no partner, nor do those that several depths have.
Partners by_key(const Names& pictures, const Names& depths,
                const std::function<std::string(const std::string&)>& key_of) {
  std::map<std::string, std::optional<std::size_t>> depth_of;
  for (std::size_t i = 0; i < depths.size(); ++i) {
    const auto [entry, is_new] = depth_of.emplace(key_of(depths[i]), i);
    if (!is_new) entry->second.reset();
  }
  Partners partners;
  for (const std::string& picture : pictures) {
    const std::string key = key_of(picture);
    const auto entry = depth_of.find(key);
    partners.push_back(key.empty() || entry == depth_of.end() ? std::nullopt : entry->second);
  }
  return partners;
}

std::string stem_of(const std::string& name) { return path(name).stem().string(); }

std::string number_of(const std::string& name) {
  const std::optional<int> number = frame_number(name);
  return number ? fmt::format("{}", *number) : "";
}

Partners by_time(const Names& pictures, const Names& depths, double max_difference_s) {
  const NameStamps of_pictures = stamps_from_names(pictures, 1.0, false);
  const NameStamps of_depths = stamps_from_names(depths, 1.0, false);
  if (!of_pictures.are_times || !of_depths.are_times) return Partners(pictures.size());
  return associate(of_pictures.stamps_s, of_depths.stamps_s, max_difference_s);
}

Partners by_position(const Names& pictures, const Names& depths) {
  Partners partners(pictures.size());
  if (pictures.size() != depths.size()) return partners;
  for (std::size_t i = 0; i < partners.size(); ++i) partners[i] = i;
  return partners;
}

Partners best_partners(const Names& pictures, const Names& depths, double max_difference_s) {
  Partners best = by_key(pictures, depths, &stem_of);
  if (2 * num_found(best) >= pictures.size()) return best;
  for (Partners other :
       {by_key(pictures, depths, &number_of), by_time(pictures, depths, max_difference_s)}) {
    if (num_found(other) > num_found(best)) best = std::move(other);
  }
  if (2 * num_found(best) >= pictures.size()) return best;
  Partners in_turn = by_position(pictures, depths);
  return num_found(in_turn) > 0 ? in_turn : best;
}

}  // namespace

void attach_depth_folder(const path& folder, double max_difference_s,
                         std::vector<FrameFiles>& frames) {
  const Names depths = picture_names(folder);
  Names pictures;
  for (const FrameFiles& frame : frames)
    pictures.push_back(frame.images.front().filename().string());
  const Partners partners = best_partners(pictures, depths, max_difference_s);
  LeftOut left_out;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (partners[i]) {
      frames[i].depth = folder / depths[*partners[i]];
    } else {
      left_out.add(
          fmt::format("{}: holds no depth image of {}, by its name, its number or its time",
                      folder.string(), frames[i].name));
    }
  }
  left_out.refuse_most(frames.size(), "pictures");
  left_out.warn(frames.size(), "depth images");
}

}  // namespace samewhere::input
