#pragma once

#include <functional>
#include <memory>
#include <vector>

#include <opencv2/core/mat.hpp>

#include <samewhere/features/vocabulary.hpp>
#include <samewhere/pipeline/config.hpp>

namespace samewhere::paper {

// The vocabulary of retrieve.vocabulary. Throws InputError.
std::shared_ptr<const features::Vocabulary> vocabulary_of(const pipeline::Config& config);

struct WeightedWord {
  features::Word word = 0;
  double weight = 0.0;
};

// The words of a view, ascending, each once.
using BagOfWords = std::vector<WeightedWord>;

// How views of a bag are compared.
enum class BagNorm {
  kL1,  // weights sum to 1; score: 1 - |v - w| / 2, the sum of the smaller weights
  kL2,  // weights have length 1; score: 1 - sqrt(1 - v w)
};

// Each word by how often it is there, times its weight; normalized. A word of weight 0 is left out.
BagOfWords make_bag(std::vector<features::Word> words, BagNorm norm,
                    const std::function<double(features::Word)>& weight_of);

// Term frequency times inverse document frequency, ln(N / n) of the pictures of the vocabulary; L1.
BagOfWords tf_idf(const features::Vocabulary& vocabulary, const cv::Mat& descriptors);

double score_of(const BagOfWords& a, const BagOfWords& b, BagNorm norm);

// A view that shares words with a query.
struct ScoredBag {
  int position = 0;
  double score = 0.0;
  int num_shared = 0;  // words
};

// Bags by their words: an inverted file (Sivic and Zisserman 2003). Positions count from 0.
class InvertedFile {
 public:
  InvertedFile(int num_words, BagNorm norm);

  void append(const BagOfWords& bag);
  // Of positions 0 .. num_allowed - 1 those that share a word, in the order of positions.
  std::vector<ScoredBag> search(const BagOfWords& bag, int num_allowed) const;

 private:
  struct Entry {
    int position = 0;
    double weight = 0.0;
  };

  BagNorm norm_;
  int num_bags_ = 0;
  std::vector<std::vector<Entry>> entries_;  // by word, positions ascending
};

// The best first, of equals the older one; not more than `count`.
std::vector<ScoredBag> best_scored(std::vector<ScoredBag> scored, int count);

}  // namespace samewhere::paper
