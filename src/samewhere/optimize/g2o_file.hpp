#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <samewhere/optimize/pose_graph.hpp>

namespace samewhere::optimize {

// The graph in the text format of g2o (Kuemmerle et al., ICRA 2011): VERTEX_SE3:QUAT for each node
// that an edge names (and FIX for those that are held), EDGE_SE3:QUAT with the upper triangle of
// the information; a planar graph as VERTEX_SE2 and EDGE_SE2. g2o measures an edge's error in the
// frame of b and its rotation as the vector part of a quaternion, half an angle; the information is
// turned and scaled accordingly. `names` are the numbers of the nodes, their positions if empty.
// Odometry that does not lead from a number to the next is named by a line of our own, ODOMETRY a
// b, which other readers skip.
// Nodes that no edge names are left out.
inline constexpr char kG2oOdometry[] = "ODOMETRY";
std::string g2o_text(const PoseGraph& graph, const std::vector<long>& names = {});

std::vector<bool> nodes_with_edges(const PoseGraph& graph);

struct G2oGraph {
  PoseGraph graph;
  std::vector<long> names;             // of the nodes, as the file numbers them, ascending
  std::map<std::string, int> skipped;  // lines of a type that is not known, by type
};

// VERTEX_SE3:QUAT, EDGE_SE3:QUAT, VERTEX_SE2, EDGE_SE2 and FIX; lines that begin with anything else
// are counted and left out. The first edge between a number and the next is odometry, and as many
// between two numbers as lines ODOMETRY name them; every other is a loop.
// Throws InputError naming file, line, value and what was expected: a number that is none, not
// finite or of a pose beyond 1e9, a line cut short, a quaternion that is no rotation, an
// information that is not positive definite, an edge to a vertex that the file does not have, a
// vertex twice, a file without a vertex or an edge, or with planar and spatial ones.
G2oGraph read_g2o(const std::filesystem::path& path);

// Information of `edge` for g2o's error instead of ours.
core::Matrix6d g2o_information(const PoseEdge& edge);

}  // namespace samewhere::optimize
