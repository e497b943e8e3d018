#pragma once

#include <memory>

#include <samewhere/paper/methods/method.hpp>
#include <samewhere/pipeline/config.hpp>

namespace samewhere::paper {

// Bag of word groups in the manner of Fei, Tian, Choset and Li, "Bag-of-word-groups (BoWG): a
// robust and efficient loop closure detection method under perceptual aliasing", IROS 2025 (arXiv
// 2510.22529). Words weigh .7 and word groups .3, each by the score of the query with the view
// before it; the score of the view before a match at the last query is mixed in, the more the less
// it differs; the island with the largest sum must be near that of the query before; 30 inliers.
// Its distribution of features has weight 0 in its published settings and is left out. Features are
// ORB at five levels of factor 2 (published: FAST and BRIEF), words are ours. Throws InputError
// without a vocabulary.
std::unique_ptr<Method> make_bowg_method(const pipeline::Config& base);

}  // namespace samewhere::paper
