#pragma once

#include <cstdint>
#include <vector>

#include <opencv2/core/mat.hpp>

#include <samewhere/features/vocabulary.hpp>

namespace samewhere::features {

struct GrowSettings {
  int branching = 10;
  int depth = 4;       // levels below the root: at most branching^depth words
  int max_rounds = 8;  // of each clustering
  std::uint64_t seed = 0;
};

// The vocabulary of these pictures (a matrix of descriptors each, a row per feature): each node
// shares its descriptors out to its children by k-medians under the Hamming distance (each bit of a
// centre is the majority's), begun as k-means++ begins (Arthur and Vassilvitskii 2007). A node
// with no two different descriptors is a leaf. Throws ContractError if there is no descriptor.
Vocabulary grow_vocabulary(const std::vector<cv::Mat>& pictures, const GrowSettings& settings);

}  // namespace samewhere::features
