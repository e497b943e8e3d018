#pragma once

#include <vector>

#include <samewhere/scene/map_version.hpp>

namespace samewhere::scene {

// Withdraws loops (by their causes) with all changes of landmarks that they caused, and undoes the
// merges of single landmarks (`unmerged` are the landmarks that were merged, not their survivors).
//
// - Loop edges of these causes are removed, suspended ones too, and observations with these causes.
// - Merges of these causes are undone, and every later merge, of any cause, of a landmark that took
//   part in one of them, since it may rest on the false merge.
// - Merges without a cause (made by mapping) since the loop are undone if both landmarks contain
//   ones from before the loop, with every later merge of these landmarks: the false loop closure
//   may have laid two places on each other. Landmarks that are one point are merged again when they
//   are observed. Merges caused by other loops stay, and those of younger landmarks with older
//   ones. Thus, except for other loops, the partition of the landmarks from before the loop is
//   restored exactly.
// - A restored landmark is assigned to all its observations from before the merge, except in
//   keyframes culled since. Its survivor, if culled since, is restored with its free features.
// - Of keyframes older than the loop, results of bundle adjustment since the loop are dropped, and
//   culled ones return to odometry (or an earlier bundle adjustment) relative to their parents. Of
//   all keyframes, results of full bundle adjustment since the loop are dropped.
//
// Poses of live keyframes and positions in the world stay. Throws ContractError for a cause of no
// loop edge of the map and for a landmark that is not merged.
void withdraw(MapVersion& map, const std::vector<core::CandidateId>& loops,
              const std::vector<core::LandmarkId>& unmerged);

}  // namespace samewhere::scene
