#include <algorithm>
#include <cmath>
#include <cstddef>

#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
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

bool is_unit_or_zero(const std::vector<float>& vector) {
  constexpr float kTolerance = 1e-3F;
  const float squared_length = core::dot(vector, vector);
  return squared_length == 0.0F || std::abs(squared_length - 1.0F) < kTolerance;  // false on NaN
}

}  // namespace

Retriever::Retriever(const Config& config, std::uint64_t seed)
    : config_(config), seed_(seed), store_(make_store(config)) {
  core::require(config.window_frames >= 0, "window_s is resolved into window_frames");
}

void Retriever::add(const core::Descriptor& descriptor) {
  check(descriptor);
  store_.append(descriptor.frame, comparable(descriptor));
  describer_checksum_ = descriptor.describer_checksum;
}

std::vector<core::Candidate> Retriever::query(const core::Descriptor& descriptor) const {
  check(descriptor);
  const std::vector<float> vector = comparable(descriptor);
  const SearchQuery query{vector, store_.num_older(descriptor.frame, config_.window_frames)};
  core::Random random(core::seed_of(seed_, "retrieve", descriptor.frame.value()));
  const bool is_exact = config_.search == Search::kExact;
  auto found =
      is_exact ? exact_search(store_, query) : sampled_search(store_, query, config_, random);
  found = best_places(store_, std::move(found), config_);
  if (!is_exact) {
    for (ScoredPosition& scored : found) {
      scored.similarity = core::ncc(vector, store_.vector(scored.position));
    }
    std::sort(found.begin(), found.end(), is_better);
  }
  std::vector<core::Candidate> candidates;
  for (const ScoredPosition& scored : found) {
    const double similarity = std::clamp(scored.similarity, -1.0, 1.0);
    candidates.push_back({{}, descriptor.frame, store_.frame(scored.position), similarity});
  }
  return candidates;
}

void Retriever::check(const core::Descriptor& descriptor) const {
  core::require(descriptor.frame.is_valid(), "a descriptor names its frame");
  core::require(!descriptor.unit.empty() && is_unit_or_zero(descriptor.unit),
                "a descriptor has unit length or is zero");
  if (!describer_checksum_) return;
  core::require(descriptor.describer_checksum == *describer_checksum_,
                "descriptors are compared only with those of the same describer");
  core::require(descriptor.unit.size() == static_cast<std::size_t>(store_.vector_length()),
                "descriptors of one describer have one length");
}

// The form whose dot product is what the search ranks by: the NCC in exact search, the cosine in
// sampled search.
std::vector<float> Retriever::comparable(const core::Descriptor& descriptor) const {
  if (config_.search == Search::kSampled) return descriptor.unit;
  return core::centred_unit(descriptor.unit);
}

}  // namespace samewhere::retrieve
