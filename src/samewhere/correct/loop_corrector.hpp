#pragma once

#include <optional>
#include <vector>

#include <samewhere/optimize/pose_graph.hpp>
#include <samewhere/scene/map_version.hpp>

namespace samewhere::correct {

// Pose graph of the map: keyframes as nodes, by position, with odometry edges and the accepted loop
// edges. Culled keyframes have no edge. Of a camera without depth, a graph with scales.
optimize::PoseGraph pose_graph_of(const scene::MapVersion& map, const optimize::Config& config);

// The same loop between the holders (scene::holder_of) of its two keyframes. Nothing if both have
// the same holder.
std::optional<scene::LoopEdge> between_holders(const scene::MapVersion& map,
                                               const scene::LoopEdge& loop);

// A loop that the robust pose graph rejects.
struct OutlierLoop {
  scene::LoopEdge loop;
  double chi2 = 0.0;  // squared error in variances, 6 degrees of freedom
};

// Effects of a new loop.
struct Closing {
  scene::Edit edit;
  std::vector<scene::LoopEdge> accepted;  // the new one, suspended ones; not fused yet
  std::optional<OutlierLoop> rejected;    // the new one, if it is not accepted
  std::vector<OutlierLoop> withdrawn;     // accepted before
};

// The edit that adds the loop edge and moves every keyframe to the solution of the pose graph of
// odometry (refined by bundle adjustment) and loop edges. The first keyframe stays; culled ones
// move with their holders. A loop that the robust pose graph rejects (optimize/) is suspended and
// tested again with every new loop: which one of two contradicting loops is false, only a third one
// shows. So a new loop may be rejected, which moves nothing, and an older one withdrawn with all
// that it caused, in the same edit. Only losses kGnc and kGncEach reject or withdraw (overruled
// loops are withdrawn under any). `overruled`: a loop of the map that odometry rejects in favour of
// the new one. It, loops with a later query and loops accepted since, which may depend on it, are
// left out of the graph. Those that fit the solution (Config::loop_chi2) stay; the others are
// withdrawn for good, and not suspended. If the new one is rejected without them, nothing changes.
// Ignored if the map no longer has that loop. Throws ContractError if the loop has no cause, or
// names keyframes that are not in the map or not live (between_holders() returns live ones).
Closing close_loop(const scene::MapVersion& map, const scene::LoopEdge& loop,
                   const optimize::Config& config, core::CandidateId overruled = {});

// The edit that moves every keyframe to the solution of the pose graph of the map.
scene::Edit solve_poses(const scene::MapVersion& map, const optimize::Config& config);

// The edit that withdraws a loop of the map with all that it caused, and moves every keyframe to
// the solution of the pose graph without it. Observations and merges that the loop made possible
// without being their cause are left to map::part_places(). Throws ContractError for a cause of no
// loop of the map, accepted or suspended.
scene::Edit withdraw_loop(const scene::MapVersion& map, core::CandidateId cause,
                          const optimize::Config& config);

}  // namespace samewhere::correct
