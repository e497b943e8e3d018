#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include <samewhere/core/ledger.hpp>
#include <samewhere/pipeline/config.hpp>
#include <samewhere/scene/map_file.hpp>

namespace samewhere::pipeline {

// What a person's word on one candidate makes of a map.
struct ByHand {
  scene::MapVersion map;
  core::Ledger rows;  // new last verdicts: the candidate's, and of loops withdrawn for its sake
};

// The map as if the loop had never been accepted (withdrawal.hpp). Throws InputError if the
// candidate is no loop.
ByHand rejected_by_hand(const scene::MapVersion& map, const core::LedgerRow& row,
                        const Config& config);

// The map with the loop that the judge refused: by its relative pose as it was measured, poses
// solved, places fused, all of it bundled. The graph of odometry and loops is still asked. Throws
// InputError if the candidate is a loop already, was taken for a lost view, has no relative pose,
// or has one in lengths that the map has no more; and if the graph does not go with it.
ByHand forced_by_hand(const scene::MapVersion& map, const core::LedgerRow& row,
                      const Config& config);

// How a finished run was changed.
struct ChangedRun {
  core::Ledger rows;
  std::size_t num_loops_before = 0;
  std::size_t num_loops = 0;
  double farthest_m = 0.0;  // that a keyframe moved
};

enum class Word { kReject, kForce };

// The same in the folder of a finished run: map.sw, in one transaction, then loops.json,
// trajectory.tum, frames.csv and map.ply, each whole or not at all. The assignments
// "section.key=value" change the run's config. Throws InputError also if there is no such
// candidate, or the folder has no map of its own.
ChangedRun change_run(const std::filesystem::path& folder, std::size_t candidate, Word word,
                      const std::vector<std::string>& assignments);

}  // namespace samewhere::pipeline
