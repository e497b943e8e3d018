#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <samewhere/evaluate/precision_recall.hpp>

namespace samewhere::evaluate {

// Place of one image of the sequence.
struct WalkPlace {
  std::string floor;
  std::string clip;  // one video clip
};

// Reads lines "image floor [clip]" (core::read_text_lines); without a clip each floor is one.
// Throws InputError naming file and line on a line with fewer words.
std::vector<WalkPlace> read_walk(const std::filesystem::path& path);

// Accepted loops of a sequence through look-alike floors: every loop between two floors is false.
struct WalkCounts {
  int num_loops = 0;
  int num_false = 0;       // between two floors
  int num_same_floor = 0;  //
  int num_same_clip = 0;   // of these
};

// Throws InputError on a loop outside the walk.
WalkCounts count_walk(const std::vector<WalkPlace>& walk, const std::vector<Match>& accepted);

}  // namespace samewhere::evaluate
