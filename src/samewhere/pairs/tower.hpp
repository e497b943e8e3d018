#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace samewhere::pairs {

// Whether this is the folder of IE Tower: a dataset.csv beside a walk.txt.
bool is_tower(const std::filesystem::path& source);

struct TowerImage {
  std::string floor;
  std::string clip;
  bool is_gallery = false;
};

// The images of IE Tower in the order of its walk.txt. Throws InputError.
std::vector<TowerImage> read_tower(const std::filesystem::path& folder);

}  // namespace samewhere::pairs
