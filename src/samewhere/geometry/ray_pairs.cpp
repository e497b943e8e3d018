#include <samewhere/geometry/ray_pairs.hpp>

namespace samewhere::geometry {

RayPairs subset(const RayPairs& pairs, const std::vector<int>& indices) {
  RayPairs chosen{{}, {}, pairs.focal_px};
  for (const int i : indices) {
    chosen.first.push_back(pairs.first[static_cast<std::size_t>(i)]);
    chosen.second.push_back(pairs.second[static_cast<std::size_t>(i)]);
  }
  return chosen;
}

}  // namespace samewhere::geometry
