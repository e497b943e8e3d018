#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>

#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/model_file.hpp>
#include <samewhere/core/random.hpp>
#include <samewhere/core/similarity.hpp>
#include <samewhere/retrieve/retriever.hpp>
#include <samewhere/retrieve/search.hpp>

namespace samewhere::retrieve {
namespace {

SegmentedStore make_store(const Config& config) {
  if (config.group_size % config.queue_size != 0) {
    throw core::InputError(
        fmt::format("retrieve.group_size = {} must be a multiple of retrieve.queue_size = {}",
                    config.group_size, config.queue_size));
  }
  return {config.group_size, config.queue_size};
}

}  // namespace

Retriever::Retriever(const Config& config, std::uint64_t seed)
    : config_(config), seed_(seed), store_(make_store(config)) {
  core::require(config.window_frames >= 0, "window_s is resolved into window_frames");
  if (config.word_candidates > 0) {
    words_.emplace(std::make_shared<const features::Vocabulary>(features::load_vocabulary(
        core::find_model("retrieve.vocabulary", config.vocabulary,
                         "a file of `samewhere train words`, DBoW2 or FBoW"))));
  }
}

void Retriever::add(const core::Descriptor& descriptor, const cv::Mat& features) {
  check(descriptor);
  store_.append(descriptor.frame, descriptor.unit);
  if (words_) words_->append(features);
  describer_checksum_ = descriptor.describer_checksum;
}

void Retriever::forget() {
  store_ = make_store(config_);
  if (words_) words_->forget();
}

core::Descriptor Retriever::view(int position) const {
  const std::span<const float> unit = store_.vector(position);
  return {store_.frame(position), {unit.begin(), unit.end()}, *describer_checksum_};
}

std::vector<FoundView> Retriever::search(const core::Descriptor& descriptor,
                                         const cv::Mat& features) const {
  check(descriptor);
  const int num_allowed = store_.num_older(descriptor.frame, config_.window_frames);
  return found_by(descriptor, features, num_allowed, config_);
}

std::vector<FoundView> Retriever::shortlist(const core::Descriptor& descriptor,
                                            const cv::Mat& features) const {
  check(descriptor);
  Config more = config_;
  more.num_candidates = std::max(config_.num_candidates, config_.shortlist);
  if (config_.word_candidates > 0)
    more.word_candidates = std::max(config_.word_candidates, config_.shortlist);
  const int num_allowed = store_.num_older(descriptor.frame, config_.window_frames);
  return found_by(descriptor, features, num_allowed, more);
}

std::vector<FoundView> Retriever::search_places(const core::Descriptor& descriptor,
                                                const cv::Mat& features) const {
  check(descriptor);
  Config lost = config_;
  lost.num_candidates = lost.word_candidates = config_.relocalization_candidates;
  lost.place_frames = config_.relocalization_place_frames;
  constexpr int kNoWindow = 0;
  const int num_allowed = store_.num_older(descriptor.frame, kNoWindow);
  return found_by(descriptor, features, num_allowed, lost);
}

std::vector<FoundView> Retriever::found_by(const core::Descriptor& descriptor,
                                           const cv::Mat& features, int num_allowed,
                                           const Config& config) const {
  const std::vector<ScoredPosition> alike =
      best_places(store_, scored(descriptor, num_allowed), config);
  std::vector<FoundView> found;
  for (const ScoredPosition& one : alike) found.push_back(view_at(one.position));
  if (!words_) return found;
  Config by_words = config;
  by_words.num_candidates = config.word_candidates;
  for (const ScoredPosition& one :
       best_places(store_, words_->search(features, num_allowed), by_words)) {
    const bool is_known = std::any_of(alike.begin(), alike.end(), [&](const ScoredPosition& other) {
      return other.position == one.position;
    });
    if (is_known) continue;
    found.push_back(view_at(one.position));
    found.back().origin = core::Origin::kVisualWords;
  }
  return found;
}

FoundView Retriever::view_at(int position) const {
  const std::span<const float> vector = store_.vector(position);
  return {store_.frame(position), {vector.begin(), vector.end()}};
}

std::vector<ScoredPosition> Retriever::scored(const core::Descriptor& descriptor,
                                              int num_allowed) const {
  switch (config_.search) {
    case Search::kExact:
      return exact_search(store_, {core::centred_unit(descriptor.unit), num_allowed});
    case Search::kEveryQueue:
      return every_queue_search(store_, {descriptor.unit, num_allowed}, config_);
    case Search::kSampled:
      break;
  }
  core::Random random(core::seed_of(seed_, "retrieve", descriptor.frame.value()));
  return sampled_search(store_, {descriptor.unit, num_allowed}, config_, random);
}

void Retriever::check(const core::Descriptor& descriptor) const {
  core::require(descriptor.frame.is_valid(), "a descriptor names its frame");
  core::require(!descriptor.unit.empty() && core::is_unit_or_zero(descriptor.unit),
                "a descriptor has unit length or is zero");
  if (!describer_checksum_) return;
  core::require(descriptor.describer_checksum == *describer_checksum_,
                "descriptors are compared only with those of the same describer");
  const auto length = static_cast<std::size_t>(store_.vector_length());
  core::require(store_.num_vectors() == 0 || descriptor.unit.size() == length,
                "descriptors of one describer have one length");
}

std::vector<core::Candidate> compare(const core::Descriptor& query,
                                     const std::vector<FoundView>& found) {
  std::vector<core::Candidate> candidates;
  for (const FoundView& view : found) {
    candidates.push_back({.query = query.frame,
                          .match = view.frame,
                          .similarity = core::ncc(query.unit, view.unit),
                          .origin = view.origin});
  }
  std::sort(
      candidates.begin(), candidates.end(), [](const core::Candidate& a, const core::Candidate& b) {
        return a.similarity > b.similarity || (a.similarity == b.similarity && a.match < b.match);
      });
  return candidates;
}

}  // namespace samewhere::retrieve
