#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include <samewhere/core/ledger.hpp>
#include <samewhere/pipeline/config.hpp>
#include <samewhere/scene/map_file.hpp>

namespace samewhere::run {

// A map after the verdict on one candidate was overridden.
struct OverriddenMap {
  scene::MapVersion map;
  core::Ledger rows;  // new last verdicts: the candidate's, then of loops whose fate it changed
};

// The map as if the loop had never been accepted (withdrawal.hpp). Loops that were withdrawn for
// its sake stay so. Throws InputError if the candidate is no loop, or was taken for a lost view.
OverriddenMap with_rejected(const scene::MapVersion& map, const core::LedgerRow& row,
                            const pipeline::Config& config);

// The map with the loop that the verifier rejected: by its measured relative pose, with pose graph
// optimization, fusion and full bundle adjustment. The robust pose graph still decides. Throws
// InputError if the candidate is a loop already, was taken for a lost view, has no relative pose,
// or has one between views or in lengths that the map has no more; and if the graph rejects
// it. `ledger`: of the run, to tell what is known of other loops.
OverriddenMap with_forced(const scene::MapVersion& map, const core::LedgerRow& row,
                          const core::Ledger& ledger, const pipeline::Config& config);

// How a finished run was changed.
struct OverriddenRun {
  core::Ledger rows;
  std::size_t num_loops_before = 0;
  std::size_t num_loops = 0;
  double farthest_m = 0.0;  // that a keyframe moved
};

enum class Override { kReject, kForce };

// The same in the folder of a finished run: map.sw, in one transaction, then its lists, each whole
// or not at all (run_lists.hpp: cut short, they are written anew from the map). The assignments
// "section.key=value" change the run's config. Throws InputError also if another program is writing
// into the folder, there is no such candidate, the folder has no map, one that another run has
// extended, or one that does not go with its frames; then nothing is written.
OverriddenRun override_run(const std::filesystem::path& folder, std::size_t candidate,
                           Override override_as, const std::vector<std::string>& assignments);

}  // namespace samewhere::run
