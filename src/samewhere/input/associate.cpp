#include <algorithm>
#include <cmath>
#include <tuple>

#include <samewhere/input/associate.hpp>

namespace samewhere::input {

std::vector<std::optional<std::size_t>> associate(const std::vector<double>& colour_stamps_s,
                                                  const std::vector<double>& depth_stamps_s,
                                                  double max_difference_s) {
  std::vector<std::tuple<double, std::size_t, std::size_t>> pairs;  // difference, colour, depth
  std::size_t first = 0;  // depth stamps before it are too old for this and all later images
  for (std::size_t colour = 0; colour < colour_stamps_s.size(); ++colour) {
    const double stamp_s = colour_stamps_s[colour];
    while (first < depth_stamps_s.size() && depth_stamps_s[first] < stamp_s - max_difference_s) {
      ++first;
    }
    for (std::size_t depth = first;
         depth < depth_stamps_s.size() && depth_stamps_s[depth] <= stamp_s + max_difference_s;
         ++depth) {
      pairs.emplace_back(std::abs(depth_stamps_s[depth] - stamp_s), colour, depth);
    }
  }
  std::sort(pairs.begin(), pairs.end());
  std::vector<std::optional<std::size_t>> depth_of_colour(colour_stamps_s.size());
  std::vector<bool> is_used(depth_stamps_s.size());
  for (const auto& [difference_s, colour, depth] : pairs) {
    if (depth_of_colour[colour] || is_used[depth]) continue;
    depth_of_colour[colour] = depth;
    is_used[depth] = true;
  }
  return depth_of_colour;
}

}  // namespace samewhere::input
