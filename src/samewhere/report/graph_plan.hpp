#pragma once

#include <string>
#include <utility>
#include <vector>

#include <samewhere/core/rigid3.hpp>

namespace samewhere::report {

// A pose graph before and after it was solved; pairs are positions of nodes.
struct GraphRecord {
  std::string title;
  std::vector<core::Rigid3> before;  // finite
  std::vector<core::Rigid3> after;
  std::vector<std::pair<int, int>> path;  // from each node to the next
  std::vector<std::pair<int, int>> believed;
  std::vector<std::pair<int, int>> refused;
  bool is_planar = false;  // seen along z; else along the direction in which it extends least
};

// An SVG file of its own, at one scale in both directions: path before (grey) and after, loops that
// were believed and that were refused.
std::string graph_plan_svg(const GraphRecord& record);

}  // namespace samewhere::report
