#pragma once

#include <memory>

#include <samewhere/paper/methods/method.hpp>
#include <samewhere/pipeline/config.hpp>

namespace samewhere::paper {

// Bag of words in the manner of ORB-SLAM2 (Mur-Artal and Tardos 2017; loop candidates as in
// ORB-SLAM, 2015, section VII). The best match is the one of the highest score. A loop is accepted
// if its candidate shares enough words, is about as good as the best with its neighbours, is
// consistent with those of three queries before, and matches geometrically. Where that has a map
// this has none: the neighbours of a frame are those nearest in time in place of the most
// covisible, each frame is a keyframe, and a fundamental matrix with the same number of inliers is
// in place of the similarity transform. Throws InputError without a vocabulary.
std::unique_ptr<Method> make_words_method(const pipeline::Config& base);

// The ten best by score, ranked by matches that agree on a fundamental matrix. Throws as above.
std::unique_ptr<Method> make_words_geometry_method(const pipeline::Config& base);

}  // namespace samewhere::paper
