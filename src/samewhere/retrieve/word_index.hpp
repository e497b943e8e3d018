#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include <opencv2/core/mat.hpp>

#include <samewhere/features/vocabulary.hpp>
#include <samewhere/retrieve/search.hpp>

namespace samewhere::retrieve {

// Retrieval by visual words. An inverted file with Hamming embedding (Jegou, Douze
// and Schmid, ECCV 2008): a feature of the query votes for each view that has one of the same word
// whose signature is near, the more the nearer, and the rarer the word is.
//
// Word frequencies are updated along the way, starting from those of the training images of the
// vocabulary: words that most places show have little weight. 12 bytes per feature.
class WordIndex {
 public:
  // Throws ContractError without a vocabulary.
  explicit WordIndex(std::shared_ptr<const features::Vocabulary> vocabulary);

  // The next view, by the descriptors of its features, a row each; it may have none. Positions
  // count from 0.
  void append(const cv::Mat& descriptors);
  // All views: positions count from 0 again, words are as rare as in the training images.
  void forget() { *this = WordIndex(vocabulary_); }
  int num_views() const { return static_cast<int>(num_features_.size()); }

  // The views of positions 0 .. num_allowed - 1 that anything votes for, in the order of positions.
  // The similarity is the sum of the votes over the root of the number of features of the view: to
  // be compared among the views of one query alone.
  std::vector<ScoredPosition> search(const cv::Mat& descriptors, int num_allowed) const;

 private:
  struct Entry {
    std::int32_t position = 0;
    std::array<std::uint32_t, 2> signature{};  // the first 64 bits of the descriptor
  };

  void vote(const unsigned char* descriptor, int num_allowed, std::vector<double>& votes,
            std::vector<double>& best) const;
  double rarity(features::Word word) const;

  std::shared_ptr<const features::Vocabulary> vocabulary_;
  std::vector<std::vector<Entry>> entries_;  // by word, positions ascending
  std::vector<int> views_with_;              // by word
  std::vector<int> num_features_;            // by position
};

}  // namespace samewhere::retrieve
