#pragma once

#include <string>

#include <samewhere/optimize/pose_graph.hpp>

namespace samewhere::optimize {

// The graph in the text format of g2o (Kuemmerle et al., ICRA 2011): VERTEX_SE3:QUAT for each node
// that an edge names (and FIX for the fixed one), EDGE_SE3:QUAT with the upper triangle of the
// information. g2o measures an edge's error in the frame of b and its rotation as the vector part
// of a quaternion, half an angle; the information is turned and scaled accordingly.
std::string g2o_text(const PoseGraph& graph);

// Information of `edge` for g2o's error instead of ours.
core::Matrix6d g2o_information(const PoseEdge& edge);

}  // namespace samewhere::optimize
