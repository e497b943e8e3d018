#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace samewhere::bench {

// Whether this is IE Tower: a folder with a dataset.csv beside a walk.txt.
bool is_tower(const std::filesystem::path& folder);

struct TowerImage {
  std::string floor;
  std::string clip;
  bool is_gallery = false;
};

// The images of IE Tower in the order of its walk.txt. Throws InputError naming the file and line
// that does not fit.
std::vector<TowerImage> read_tower(const std::filesystem::path& folder);

}  // namespace samewhere::bench
