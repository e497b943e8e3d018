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
  std::vector<float> weights;  // both kinds weigh the same over all pairs, 1 in the mean
};

// The pair as another walk might have laid it: either view first, mirrored, seen from elsewhere,
// registered a little beside it, in other light, with matches and differences missed, or with its
// pictures hidden. `planes` are those of verify::PairView; so are the returned.
cv::Mat distorted_pair(const cv::Mat& planes, const PairConfig& config, core::Random& random);

// Makes batches of some pairs.
class PairExampleMaker {
 public:
  // Weighs the kinds by how many of each `indices` name. `pairs` must outlive it.
  PairExampleMaker(const PairConfig& config, std::span<const PairExample> pairs,
                   std::span<const int> indices);

  // Distorted; pair i as `seed` and i say.
  PairBatch distorted(std::span<const int> indices, std::uint64_t seed) const;
  // As they are.
  PairBatch plain(std::span<const int> indices) const;

 private:
  void add(const PairExample& pair, const cv::Mat& planes, PairBatch& batch) const;

  PairConfig config_;
  std::span<const PairExample> pairs_;
  float weight_of_same_ = 1.0F;
  float weight_of_wrong_ = 1.0F;
};

}  // namespace samewhere::train
