#pragma once

#include <cstdint>

#include <samewhere/features/config.hpp>
#include <samewhere/features/features.hpp>

namespace samewhere::paper {

// The geometric check of the methods that are compared.
struct InlierCheck {
  features::Config features;  // max_distance_bits and max_ratio of a match
  int min_matches = 8;        // fewer are not tried
  double max_error_px = 3.0;
  int max_iterations = 500;
  std::uint64_t seed = 0;
};

// Matches of two views that agree on one fundamental matrix, by RANSAC seeded by the pair; 0 if
// none explains eight.
int count_inliers(const features::View& query, const features::View& match,
                  const InlierCheck& check);

}  // namespace samewhere::paper
