#include <algorithm>
#include <cmath>
#include <utility>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/model_file.hpp>
#include <samewhere/paper/methods/bag_of_words.hpp>

namespace samewhere::paper {
namespace {

double share_of(double a, double b, BagNorm norm) {
  return norm == BagNorm::kL1 ? std::min(a, b) : a * b;
}

double score_of_shares(double sum, BagNorm norm) {
  return norm == BagNorm::kL1 ? sum : 1.0 - std::sqrt(std::max(0.0, 1.0 - sum));
}

void normalize(BagOfWords& bag, BagNorm norm) {
  double sum = 0.0;
  for (const WeightedWord& entry : bag)
    sum += norm == BagNorm::kL1 ? entry.weight : entry.weight * entry.weight;
  const double length = norm == BagNorm::kL1 ? sum : std::sqrt(sum);
  for (WeightedWord& entry : bag) entry.weight /= length;
}

}  // namespace

std::shared_ptr<const features::Vocabulary> vocabulary_of(const pipeline::Config& config) {
  return std::make_shared<const features::Vocabulary>(features::load_vocabulary(
      core::find_model("retrieve.vocabulary", config.retrieve.vocabulary, "a vocabulary")));
}

BagOfWords make_bag(std::vector<features::Word> words, BagNorm norm,
                    const std::function<double(features::Word)>& weight_of) {
  std::sort(words.begin(), words.end());
  BagOfWords bag;
  for (const features::Word word : words) {
    if (bag.empty() || bag.back().word != word) bag.push_back({word, 0.0});
    bag.back().weight += 1.0;
  }
  for (WeightedWord& entry : bag) entry.weight *= weight_of(entry.word);
  std::erase_if(bag, [](const WeightedWord& entry) { return !(entry.weight > 0.0); });
  normalize(bag, norm);
  return bag;
}

BagOfWords tf_idf(const features::Vocabulary& vocabulary, const cv::Mat& descriptors) {
  return make_bag(vocabulary.words_of(descriptors), BagNorm::kL1, [&](features::Word word) {
    const double with = std::max(1U, vocabulary.pictures_with(word));
    return std::log(vocabulary.num_pictures() / with);
  });
}

double score_of(const BagOfWords& a, const BagOfWords& b, BagNorm norm) {
  double sum = 0.0;
  auto other = b.begin();
  for (const WeightedWord& entry : a) {
    while (other != b.end() && other->word < entry.word) ++other;
    if (other != b.end() && other->word == entry.word)
      sum += share_of(entry.weight, other->weight, norm);
  }
  return score_of_shares(sum, norm);
}

InvertedFile::InvertedFile(int num_words, BagNorm norm)
    : norm_(norm), entries_(static_cast<std::size_t>(num_words)) {}

void InvertedFile::append(const BagOfWords& bag) {
  for (const WeightedWord& entry : bag) entries_[entry.word].push_back({num_bags_, entry.weight});
  ++num_bags_;
}

std::vector<ScoredBag> InvertedFile::search(const BagOfWords& bag, int num_allowed) const {
  core::require(num_allowed <= num_bags_, "only bags that were appended are allowed");
  if (num_allowed <= 0) return {};
  std::vector<ScoredBag> all(static_cast<std::size_t>(num_allowed));
  for (const WeightedWord& word : bag) {
    for (const Entry& entry : entries_[word.word]) {
      if (entry.position >= num_allowed) break;
      ScoredBag& scored = all[static_cast<std::size_t>(entry.position)];
      scored.score += share_of(word.weight, entry.weight, norm_);
      ++scored.num_shared;
    }
  }
  std::vector<ScoredBag> shared;
  for (int position = 0; position < num_allowed; ++position) {
    ScoredBag& scored = all[static_cast<std::size_t>(position)];
    if (scored.num_shared == 0) continue;
    shared.push_back({position, score_of_shares(scored.score, norm_), scored.num_shared});
  }
  return shared;
}

std::vector<ScoredBag> best_scored(std::vector<ScoredBag> scored, int count) {
  const std::size_t kept = std::min(static_cast<std::size_t>(count), scored.size());
  std::partial_sort(scored.begin(), scored.begin() + static_cast<std::ptrdiff_t>(kept),
                    scored.end(), [](const ScoredBag& a, const ScoredBag& b) {
                      return a.score != b.score ? a.score > b.score : a.position < b.position;
                    });
  scored.resize(kept);
  return scored;
}

}  // namespace samewhere::paper
