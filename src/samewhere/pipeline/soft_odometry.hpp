#pragma once

#include <optional>

#include <samewhere/pipeline/config.hpp>
#include <samewhere/scene/map_version.hpp>

namespace samewhere::pipeline {

// The map for a pose graph, whose edges are independent: of odometry from a file each edge gets a
// share of the systematic drift, so that their sum over the longest loop, known or `new_loop`, is
// that drift. The map itself without odometry from a file. Only the information of odometry edges
// differs.
scene::MapVersion with_soft_odometry(const scene::MapVersion& map, const Config& config,
                                     const std::optional<scene::LoopEdge>& new_loop = {});

}  // namespace samewhere::pipeline
