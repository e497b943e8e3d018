#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include <samewhere/features/features.hpp>
#include <samewhere/paper/methods/bag_of_words.hpp>

namespace samewhere::paper {

// The dictionary of word groups of BoWG (Fei, Tian, Choset and Li, IROS 2025), as its published
// program has it: a group is the word of a feature that has another feature nearer than its own
// size, and is there once for each such neighbour. How rare a group is, is learned as views come.
class WordGroups {
 public:
  // `size_px`: of a feature of octave 0; of octave n it is scale^n times that.
  WordGroups(double size_px, double scale) : size_px_(size_px), scale_(scale) {}

  // The groups of a view, L2, by term frequency and ln(groups so far / times of this group so far),
  // its own counted. `words`: one a feature.
  BagOfWords learn(const features::Features& features, const std::vector<features::Word>& words);

 private:
  double size_px_;
  double scale_;
  std::map<features::Word, std::int64_t> times_;
  std::int64_t num_groups_ = 0;
};

}  // namespace samewhere::paper
