#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>

namespace samewhere::pairs {

// The folder of IE Tower, or some of its floors: "FOLDER?floors=floor3,floor5", so that what is
// learnt from and what is measured on can be different floors.
struct TowerSource {
  std::filesystem::path folder;
  std::set<std::string> floors;  // none: all

  bool has(const std::string& floor) const { return floors.empty() || floors.contains(floor); }
};

// Throws InputError if floors are asked for and none is named.
TowerSource tower_source(const std::string& source);

// Whether this is IE Tower: a folder with a dataset.csv beside a walk.txt.
bool is_tower(const std::string& source);

struct TowerImage {
  std::string floor;
  std::string clip;
  bool is_gallery = false;
};

// The images of IE Tower in the order of its walk.txt. Throws InputError, also for a floor that is
// not there.
std::vector<TowerImage> read_tower(const TowerSource& source);

}  // namespace samewhere::pairs
