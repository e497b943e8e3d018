#pragma once

#include <span>
#include <vector>

#include <opencv2/core/mat.hpp>

#include <samewhere/core/random.hpp>
#include <samewhere/train/pair_config.hpp>
#include <samewhere/train/pair_set.hpp>

namespace samewhere::train {

// So many pairs one after the other.
struct PairBatch {
  int num_examples = 0;
  std::vector<float> planes;   // of each, as verify::PairView has them
  std::vector<float> is_same;  // 1 or 0
  std::vector<float> weights;  // see PairExampleMaker
};

// The pair as another walk might have laid it: either view first, mirrored, seen from elsewhere,
// registered a little beside it, in other light, with matches and differences missed, or with its
// pictures, and where they are alike, hidden. `planes` are those of verify::PairView; so are the
// returned.
cv::Mat distorted_pair(const cv::Mat& planes, const PairConfig& config, core::Random& random);

// What each pair of a set counts: of the pairs to learn from, and of those to validate with, both
// kinds weigh the same, 1 in the mean. So they do, nearly, within each source that has both, lest
// the looks of a building tell the kind.
std::vector<float> weights_of(const PairSet& set);

// Makes batches of the pairs of a set, which must outlive it.
class PairExampleMaker {
 public:
  PairExampleMaker(const PairConfig& config, const PairSet& set)
      : config_(config), pairs_(set.pairs), weights_(weights_of(set)) {}

  // Distorted; pair i as `seed` and i say.
  PairBatch distorted(std::span<const int> indices, std::uint64_t seed) const;
  // As they are.
  PairBatch plain(std::span<const int> indices) const;

 private:
  void add(int index, const cv::Mat& planes, PairBatch& batch) const;

  PairConfig config_;
  std::span<const PairExample> pairs_;
  std::vector<float> weights_;
};

}  // namespace samewhere::train
