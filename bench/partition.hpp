#pragma once

#include <set>
#include <vector>

#include <samewhere/scene/map_version.hpp>

namespace samewhere::bench {

// Change of the partition of landmarks into classes; a class holds those that were merged.
struct PartitionChange {
  // Earlier classes beyond one in each later class, and later ones beyond one in each earlier
  // class: 0 and 0 if both partitions are the same.
  int num_joined = 0;
  int num_parted = 0;
  // Each later class that joins several: the landmarks that represented those before.
  std::vector<std::vector<core::LandmarkId>> joined;
};

// Of the landmarks of `before`; `after` is a later version of the same map (else ContractError).
// `ignored`: merges of `after` with these causes do not count.
PartitionChange partition_change(const scene::MapVersion& before, const scene::MapVersion& after,
                                 const std::set<core::CandidateId>& ignored = {});

}  // namespace samewhere::bench
