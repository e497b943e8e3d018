#include "partition.hpp"

#include <map>
#include <numeric>
#include <utility>

#include <samewhere/core/errors.hpp>

namespace samewhere::bench {
namespace {

// Per landmark of the map one that is the same for all of its class.
std::vector<std::size_t> classes_of(const scene::MapVersion& map,
                                    const std::set<core::CandidateId>& ignored) {
  std::vector<std::size_t> next(map.landmarks.size());
  std::iota(next.begin(), next.end(), 0U);
  for (std::size_t i = 0; i < map.merges.size(); ++i) {
    const scene::Merge& made = map.merges[i];
    if (!ignored.contains(made.cause)) next[made.from.index()] = made.to.index();
  }
  // a landmark is merged once, into one that is not merged yet: no circles
  for (std::size_t i = 0; i < next.size(); ++i)
    while (next[next[i]] != next[i]) next[i] = next[next[i]];
  return next;
}

}  // namespace

PartitionChange partition_change(const scene::MapVersion& before, const scene::MapVersion& after,
                                 const std::set<core::CandidateId>& ignored) {
  core::require(before.landmarks.size() <= after.landmarks.size(), "a map only grows");
  const auto was = classes_of(before, {});
  const auto is = classes_of(after, ignored);
  std::map<std::size_t, std::set<std::size_t>> were;  // per class of today
  std::map<std::size_t, std::set<std::size_t>> are;   // per class of before
  for (std::size_t i = 0; i < was.size(); ++i) {
    were[is[i]].insert(was[i]);
    are[was[i]].insert(is[i]);
  }
  PartitionChange change;
  for (const auto& [today, parts] : were) {
    change.num_joined += static_cast<int>(parts.size()) - 1;
    if (parts.size() == 1) continue;
    auto& joined = change.joined.emplace_back();
    for (const std::size_t part : parts) joined.emplace_back(part);
  }
  for (const auto& [once, parts] : are) change.num_parted += static_cast<int>(parts.size()) - 1;
  return change;
}

}  // namespace samewhere::bench
