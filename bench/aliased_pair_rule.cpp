#include "aliased_pair_rule.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>
#include <utility>

#include "tower.hpp"
#include <samewhere/core/errors.hpp>
#include <samewhere/core/random.hpp>

namespace samewhere::bench {
namespace {

constexpr double kOwnMoment_s = 10.0;
constexpr std::uint64_t kPermutationSeed = 0;

std::vector<int> every(int step, int num_frames) {
  std::vector<int> frames;
  for (int frame = 0; frame < num_frames; frame += step) frames.push_back(frame);
  return frames;
}

using Pairs = std::set<std::pair<int, int>>;  // in both orders

// The aliased pairs of the truth, in both orders.
Pairs listed_pairs(const core::Truth& truth) {
  Pairs pairs;
  for (const core::FramePair& pair : truth.aliased_pairs) {
    pairs.emplace(pair.query, pair.match);
    pairs.emplace(pair.match, pair.query);
  }
  return pairs;
}

AliasedPairRule rule_of_places(const KnownFrames& frames, int query_step) {
  const auto is_elsewhere = [places = *frames.truth.places](int query, int match) {
    return places.at(query, match) == core::PlaceTruth::kDifferent &&
           places.at(match, query) == core::PlaceTruth::kDifferent;
  };
  const auto offer = [is_elsewhere, stamps_s = frames.stamps_s](int query, int match) {
    const double apart_s = std::abs(stamps_s[static_cast<std::size_t>(query)] -
                                    stamps_s[static_cast<std::size_t>(match)]);
    return apart_s > kOwnMoment_s && is_elsewhere(query, match) ? Offer::kAliased
                                                                : Offer::kTakenOut;
  };
  return {"other places", every(query_step, static_cast<int>(frames.names.size())), offer};
}

AliasedPairRule rule_of_list(const Pairs& pairs, int query_step) {
  AliasedPairRule rule{.name = "aliased pairs", .queries = {}, .offer = nullptr};
  int next_query = 0;
  // not the multiples of the step: a short list may contain none of those
  for (const auto& [query, match] : pairs) {
    if (query < next_query) continue;
    rule.queries.push_back(query);
    next_query = query + query_step;
  }
  rule.offer = [pairs](int query, int match) {
    return pairs.contains({query, match}) ? Offer::kAliased : Offer::kTakenOut;
  };
  return rule;
}

}  // namespace

std::vector<AliasedPairRule> rules_of_truth(const KnownFrames& frames, int query_step) {
  std::vector<AliasedPairRule> rules;
  if (frames.truth.places) rules.push_back(rule_of_places(frames, query_step));
  const Pairs listed = listed_pairs(frames.truth);
  if (!listed.empty()) rules.push_back(rule_of_list(listed, query_step));
  if (rules.empty()) {
    throw core::InputError("the truth has no places; expected a place matrix");
  }
  return rules;
}

AliasedPairRule tower_rule(const std::filesystem::path& folder, int num_queries) {
  const auto images = std::make_shared<const std::vector<TowerImage>>(read_tower(folder));
  std::vector<int> all_queries;
  for (std::size_t i = 0; i < images->size(); ++i) {
    if (!(*images)[i].is_gallery) all_queries.push_back(static_cast<int>(i));
  }
  const int num_all = static_cast<int>(all_queries.size());
  AliasedPairRule rule{.name = "clip-out", .queries = {}, .offer = nullptr};
  core::Random random(kPermutationSeed);
  for (const int drawn : random.distinct_indices(std::min(num_queries, num_all), num_all)) {
    rule.queries.push_back(all_queries[static_cast<std::size_t>(drawn)]);
  }
  std::sort(rule.queries.begin(), rule.queries.end());
  rule.offer = [images](int query, int match) {
    const TowerImage& own = (*images)[static_cast<std::size_t>(query)];
    const TowerImage& other = (*images)[static_cast<std::size_t>(match)];
    if (!other.is_gallery || other.clip == own.clip) return Offer::kTakenOut;
    return other.floor == own.floor ? Offer::kSamePlace : Offer::kAliased;
  };
  return rule;
}

}  // namespace samewhere::bench
