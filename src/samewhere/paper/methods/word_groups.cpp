#include <cmath>

#include <samewhere/core/errors.hpp>
#include <samewhere/paper/methods/word_groups.hpp>

namespace samewhere::paper {

BagOfWords WordGroups::learn(const features::Features& features,
                             const std::vector<features::Word>& words) {
  core::require(static_cast<int>(words.size()) == features.size(), "one word a feature");
  std::vector<double> size_px;
  for (const int octave : features.octave) size_px.push_back(size_px_ * std::pow(scale_, octave));
  std::vector<features::Word> groups;
  for (std::size_t i = 0; i < words.size(); ++i) {
    for (std::size_t j = i + 1; j < words.size(); ++j) {
      const double distance_px = (features.raw_px[i] - features.raw_px[j]).norm();
      if (distance_px < size_px[i]) groups.push_back(words[i]);
      if (distance_px < size_px[j]) groups.push_back(words[j]);
    }
  }
  for (const features::Word group : groups) ++times_[group];
  num_groups_ += static_cast<std::int64_t>(groups.size());
  return make_bag(std::move(groups), BagNorm::kL2, [this](features::Word group) {
    return std::log(static_cast<double>(num_groups_) / static_cast<double>(times_[group]));
  });
}

}  // namespace samewhere::paper
