#pragma once

#include <filesystem>
#include <vector>

#include <samewhere/optimize/config.hpp>
#include <samewhere/report/record.hpp>

namespace samewhere::run {

// Files to be written of a solved graph; empty: not wanted.
struct GraphExports {
  std::filesystem::path g2o;
  std::filesystem::path loops;  // CSV: every loop edge, its squared error, how much it counts
  std::filesystem::path svg;    // before and after, seen from above
};

// Solves the pose graph of a g2o file and writes what is wanted, each whole or not at all; returns
// what came of it, for a person. Throws InputError if the file is none (optimize/g2o_file.hpp) or
// one cannot be written.
std::vector<report::Figure> optimize_graph(const std::filesystem::path& file,
                                           const optimize::Config& config,
                                           const GraphExports& wanted);

}  // namespace samewhere::run
