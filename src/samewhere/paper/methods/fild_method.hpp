#pragma once

#include <memory>

#include <samewhere/paper/methods/method.hpp>
#include <samewhere/pipeline/config.hpp>

namespace samewhere::paper {

// FILD++ in the manner of An, Zhu, Wei, Tsintotas and Gasteratos, "Fast and incremental loop
// closure detection with deep features and proximity graphs", Journal of Field Robotics 2022: the
// nearest views by a global descriptor in a small-world graph that frames enter when they leave the
// window, matches of local features with a ratio test, inliers under a fundamental matrix, and
// loops of consecutive queries. Five nearest views, 48 links and the ratio of .7 are those of its
// published program. The descriptor is that of `base.describe` (published: a ResNet-50), local
// features are ORB (published: DELF), a match is mutual. Throws InputError in a build without
// hnswlib, and on a describer that cannot be made.
std::unique_ptr<Method> make_fild_method(const pipeline::Config& base);

}  // namespace samewhere::paper
