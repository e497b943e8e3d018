#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <set>
#include <utility>

#include <samewhere/core/errors.hpp>
#include <samewhere/retrieve/word_index.hpp>

namespace samewhere::retrieve {
namespace {

constexpr int kMaxSignatureBits = 16;     // of 64; further apart two features are different
constexpr double kSignatureSigma = 8.0;   // bits by which a vote fades
constexpr double kPicturesOfPrior = 100;  // what the vocabulary's pictures weigh beside the views
constexpr double kSeenAtLeast = 0.5;      // pictures with a word that none has shown
constexpr int kMinFeatures = 50;          // a view with fewer does not gain by it

using Signature = std::array<std::uint32_t, 2>;

Signature signature_of(const unsigned char* descriptor) {
  Signature signature;
  std::memcpy(signature.data(), descriptor, sizeof signature);
  return signature;
}

int bits_apart(const Signature& a, const Signature& b) {
  return std::popcount(a[0] ^ b[0]) + std::popcount(a[1] ^ b[1]);
}

std::array<double, kMaxSignatureBits + 1> votes_by_bits() {
  std::array<double, kMaxSignatureBits + 1> votes{};
  for (std::size_t bits = 0; bits < votes.size(); ++bits) {
    const double sigmas = static_cast<double>(bits) / kSignatureSigma;
    votes[bits] = std::exp(-0.5 * sigmas * sigmas);
  }
  return votes;
}

}  // namespace

WordIndex::WordIndex(std::shared_ptr<const features::Vocabulary> vocabulary)
    : vocabulary_(std::move(vocabulary)) {
  core::require(vocabulary_ != nullptr, "words are those of a vocabulary");
  entries_.resize(static_cast<std::size_t>(vocabulary_->num_words()));
  views_with_.assign(entries_.size(), 0);
}

void WordIndex::append(const cv::Mat& descriptors) {
  const int position = num_views();
  for (int i = 0; i < descriptors.rows; ++i) {
    const unsigned char* descriptor = descriptors.ptr(i);
    const features::Word word = vocabulary_->word_of(descriptor);
    auto& entries = entries_[word];
    if (entries.empty() || entries.back().position != position) ++views_with_[word];
    entries.push_back({position, signature_of(descriptor)});
  }
  num_features_.push_back(descriptors.rows);
}

// Inverse document frequency, over the views and the pictures before them.
double WordIndex::rarity(features::Word word) const {
  const double prior_with = kPicturesOfPrior * (vocabulary_->pictures_with(word) + kSeenAtLeast) /
                            (vocabulary_->num_pictures() + 1.0);
  return std::log((kPicturesOfPrior + num_views()) / (prior_with + views_with_[word]));
}

// `best` is all zero, before and after.
void WordIndex::vote(const unsigned char* descriptor, int num_allowed, std::vector<double>& votes,
                     std::vector<double>& best) const {
  static const auto by_bits = votes_by_bits();
  const features::Word word = vocabulary_->word_of(descriptor);
  const double rarity = std::max(0.0, this->rarity(word));
  const Signature signature = signature_of(descriptor);
  const auto each_near = [&](const auto& use) {
    for (const Entry& entry : entries_[word]) {
      if (entry.position >= num_allowed) break;
      const int bits = bits_apart(signature, entry.signature);
      if (bits <= kMaxSignatureBits) use(static_cast<std::size_t>(entry.position), bits);
    }
  };
  // a feature votes once for a view, however often that shows something like it
  each_near([&](std::size_t position, int bits) {
    best[position] = std::max(best[position], by_bits[static_cast<std::size_t>(bits)]);
  });
  each_near([&](std::size_t position, int /*bits*/) {
    votes[position] += std::exchange(best[position], 0.0) * rarity * rarity;
  });
}

std::vector<ScoredPosition> WordIndex::search(const cv::Mat& descriptors, int num_allowed) const {
  core::require(num_allowed <= num_views(), "only views that were appended are allowed");
  std::vector<double> votes(static_cast<std::size_t>(num_allowed), 0.0);
  std::vector<double> best(votes.size(), 0.0);
  for (int i = 0; i < descriptors.rows; ++i) vote(descriptors.ptr(i), num_allowed, votes, best);
  std::vector<ScoredPosition> scored;
  for (int position = 0; position < num_allowed; ++position) {
    const auto k = static_cast<std::size_t>(position);
    if (votes[k] > 0.0)
      scored.push_back({position, votes[k] / std::sqrt(std::max(kMinFeatures, num_features_[k]))});
  }
  return scored;
}

}  // namespace samewhere::retrieve
