#pragma once

#include <string>
#include <utility>
#include <vector>

#include <samewhere/core/rigid3.hpp>

namespace samewhere::report {

// A pose graph before and after optimization; pairs are positions of nodes.
struct GraphRecord {
  std::string title;
  std::vector<core::Rigid3> before;  // finite
  std::vector<core::Rigid3> after;
  std::vector<std::pair<int, int>> path;  // from each node to the next
  std::vector<std::pair<int, int>> accepted;
  std::vector<std::pair<int, int>> rejected;
  bool is_planar = false;  // viewed along z; else along the direction of least extent
};

// A stand-alone SVG file, at one scale in both directions: odometry before (grey) and after,
// accepted and rejected loops.
std::string graph_plan_svg(const GraphRecord& record);

}  // namespace samewhere::report
