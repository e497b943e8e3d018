#pragma once

#include <optional>
#include <vector>

#include <samewhere/optimize/pose_graph.hpp>
#include <samewhere/scene/map_version.hpp>

namespace samewhere::correct {

// Keyframes as nodes, by position, joined by their odometry and by the loops that the map believes.
// Culled keyframes hang on no edge. Of a camera without depth, a graph with scales.
optimize::PoseGraph pose_graph_of(const scene::MapVersion& map, const optimize::Config& config);

// The same loop between the keyframes that its own two hang on by now. Nothing if both hang on one.
std::optional<scene::LoopEdge> between_holders(const scene::MapVersion& map,
                                               const scene::LoopEdge& loop);

// A loop that the pose graph does not believe.
struct BentLoop {
  scene::LoopEdge loop;
  double chi2 = 0.0;  // 6 degrees of freedom; beyond optimize::Config::loop_chi2
};

// What a new loop changes.
struct Closing {
  scene::Edit edit;
  std::vector<scene::LoopEdge> believed;  // from now on: the new one, doubted ones. To be fused.
  std::optional<BentLoop> refused;        // the new one, if it is not among them
  std::vector<BentLoop> withdrawn;        // believed until now
};

// The edit that adds the loop edge and moves every keyframe to where odometry, bettered by bundles,
// and all loops fit best. The first keyframe stays; culled ones move with those that they hang on.
// A loop that the pose graph does not believe (optimize/) is kept as a doubted one, and asked again
// with every new loop: of two that contradict each other, nobody knows which one lies until a third
// speaks. So a new loop may be refused, which moves nothing, and an older one withdrawn with all
// that it caused, in the same edit. Only losses kGnc and kGncEach refuse or withdraw (overruled
// ones go under any). Throws ContractError if the loop has no cause, or names keyframes that are
// not there or not live (between_holders() answers with live ones). `overruled`: a loop of the map
// against which odometry speaks for the new one. That, those later on the path and those believed
// since, which may rest on it, are not in the graph that is solved: who fits it then
// (Config::loop_chi2) stays, who does not is withdrawn for good, and not doubted. If the new one is
// refused without them, nothing changes. Ignored if the map no longer believes that loop.
Closing close_loop(const scene::MapVersion& map, const scene::LoopEdge& loop,
                   const optimize::Config& config, core::CandidateId overruled = {});

// The edit that moves every keyframe to where odometry and the loops of the map fit best.
scene::Edit solve_poses(const scene::MapVersion& map, const optimize::Config& config);

// The edit that takes a loop of the map back with all that it caused, and moves every keyframe to
// where odometry and the other loops fit best. Landmarks that were seen or merged later because the
// loop was there, without being caused by it, are left to map::part_places(). Throws ContractError
// for a cause of no loop of the map, believed or doubted.
scene::Edit withdraw_loop(const scene::MapVersion& map, core::CandidateId cause,
                          const optimize::Config& config);

}  // namespace samewhere::correct
