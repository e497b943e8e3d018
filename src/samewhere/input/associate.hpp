#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace samewhere::input {

// For each colour stamp the index of its depth stamp (or of a second camera's), or nothing. Pairs
// at most max_difference_s apart are made greedily, the nearest in time first, each stamp used
// once: what associate.py of the TUM RGB-D benchmark does. Both lists rise.
std::vector<std::optional<std::size_t>> associate(const std::vector<double>& colour_stamps_s,
                                                  const std::vector<double>& depth_stamps_s,
                                                  double max_difference_s);

}  // namespace samewhere::input
