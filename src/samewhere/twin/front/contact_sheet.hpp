#pragma once

#include <opencv2/core/mat.hpp>

#include <samewhere/twin/building/spec.hpp>
#include <samewhere/twin/front/walkthrough.hpp>

namespace samewhere::twin {

// Both tell on stderr how far they have come, and throw core::Interrupted after Ctrl-C. BGR, 8
// bits.

// Twelve pictures of a walk, evenly spread in time from first to last, in rows of four, each 320 x
// 240.
cv::Mat contact_sheet(const Walkthrough& walk, const Config& config);

// The same place at similarity 0, 0.5, 0.9 and 1, from left to right, above its twin: an aliased
// pair pair of the walk that is nearly the most alike at similarity 1 and shows much. Each picture
// 320 x 240. The spec's own similarity has no say. Throws InputError if the building has no twins.
cv::Mat similarity_sheet(const Spec& spec, const Config& config);

}  // namespace samewhere::twin
