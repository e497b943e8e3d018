#pragma once

#include <vector>

#include <samewhere/scene/map_version.hpp>

namespace samewhere::scene {

// Takes loops back with all that was done to landmarks for them, and merges of single landmarks (by
// what was merged, not by what it went into).
//
// - The loop edges of these causes go, doubted ones too, and the observations that bear them.
// - Merges of these causes are taken back, and so is every later merge, whatever its cause, of a
//   landmark that one of them had a part in: it may have been made for the sake of the wrong part.
//   So the landmarks that these merges touched are one exactly where they were before.
// - So are merges that mapping alone made since, of wholes that both hold landmarks from before the
//   loop, with every later merge of what they touched: poses that the loop had bent, and places
//   that it had laid onto each other, may have made them. What is the same point all the same is
//   merged again when it is seen. Merges for the sake of other loops stay, and those of younger
//   landmarks with older ones. So but for other loops the partition of the landmarks from before is
//   the one from before, exactly.
// - Who comes back shows again wherever it showed when it was merged, but in keyframes that were
//   culled since. What it had gone into, if culled since, comes back with what is still free.
// - Keyframes older than the loop that a bundle refined since, and culled ones, are where odometry
//   (or a bundle before the loop) measured them, relative to their parents: the loop had bent what
//   held that bundle. What a full bundle settled since is forgotten of all keyframes.
//
// Poses of live keyframes and positions in the world stay. Throws ContractError for a cause of no
// loop edge of the map and for a landmark that is not merged.
void withdraw(MapVersion& map, const std::vector<core::CandidateId>& loops,
              const std::vector<core::LandmarkId>& unmerged);

}  // namespace samewhere::scene
