#include "tower.hpp"

#include <map>

#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/file_kind.hpp>
#include <samewhere/core/text_file.hpp>

namespace samewhere::bench {
namespace {

// Image name -> whether the data set calls it gallery.
std::map<std::string, bool> read_splits(const std::filesystem::path& csv) {
  std::map<std::string, bool> is_gallery;
  for (const core::TextLine& line : core::read_text_lines(csv)) {
    const std::string& text = line.words.front();
    const std::size_t first = text.find(',');
    const std::size_t second = text.find(',', first + 1);
    const std::size_t third = text.find(',', second + 1);
    if (first == std::string::npos || second == std::string::npos || third == std::string::npos) {
      throw core::InputError(
          fmt::format("{}: '{}', expected image,floor,split,area", line.place, text));
    }
    is_gallery[text.substr(0, first)] = text.substr(second + 1, third - second - 1) == "gallery";
  }
  return is_gallery;
}

}  // namespace

bool is_tower(const std::filesystem::path& folder) {
  return core::is_there(folder / "dataset.csv") && core::is_there(folder / "walk.txt");
}

std::vector<TowerImage> read_tower(const std::filesystem::path& folder) {
  const std::map<std::string, bool> is_gallery = read_splits(folder / "dataset.csv");
  std::vector<TowerImage> images;
  for (const core::TextLine& line : core::read_text_lines(folder / "walk.txt")) {
    const auto split = line.words.size() == 3 ? is_gallery.find(line.words[0]) : is_gallery.end();
    if (split == is_gallery.end()) {
      throw core::InputError(
          fmt::format("{}: expected an image of dataset.csv, its floor and its clip", line.place));
    }
    images.push_back({line.words[1], line.words[2], split->second});
  }
  return images;
}

}  // namespace samewhere::bench
