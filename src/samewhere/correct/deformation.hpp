#pragma once

#include <optional>

#include <samewhere/core/verdict.hpp>
#include <samewhere/optimize/config.hpp>
#include <samewhere/scene/map_version.hpp>

namespace samewhere::correct {

// Displacement of the live keyframes from match to query when the loop is added to the pose graph
// of odometry and loops, by least squares, after rigid alignment to the graph without it. After the
// trajectory prior of ROVER (Yu et al., arXiv 2508.13488). Nothing if both ends have one holder or
// fewer than three keyframes lie between. Without depth in units of the map.
std::optional<core::DeformationEvidence> measure_deformation(const scene::MapVersion& map,
                                                             const scene::LoopEdge& loop,
                                                             const optimize::Config& config);

}  // namespace samewhere::correct
