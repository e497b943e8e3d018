#pragma once

#include <set>
#include <vector>

#include <samewhere/scene/map_version.hpp>

namespace samewhere::bench {

// What became of the classes of landmarks that are one.
struct PartitionChange {
  // Classes of before beyond one in each class of today, and the other way round: 0 and 0 where
  // both partitions are the same.
  int num_joined = 0;
  int num_parted = 0;
  // Each class of today that was several: who stood for those before.
  std::vector<std::vector<core::LandmarkId>> joined;
};

// Of the landmarks of `before`, by what stands for them there and in `after`, which grew out of
// it. `ignored`: merges of `after` that loops of these causes brought do not count.
PartitionChange partition_change(const scene::MapVersion& before, const scene::MapVersion& after,
                                 const std::set<core::CandidateId>& ignored = {});

}  // namespace samewhere::bench
