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
// b, and a loop where a reader expects odometry by LOOP a b; other readers skip both.
// Nodes that no edge names are left out.
inline constexpr char kG2oOdometry[] = "ODOMETRY";
inline constexpr char kG2oLoop[] = "LOOP";
std::string g2o_text(const PoseGraph& graph, const std::vector<long>& names = {});

std::vector<bool> nodes_with_edges(const PoseGraph& graph);

struct G2oGraph {
  PoseGraph graph;
  std::vector<long> names;             // of the nodes, as the file numbers them, ascending
  std::map<std::string, int> skipped;  // lines of a type that is not known, by type
  bool is_without_vertices = false;    // the nodes were laid out along the edges
};

// VERTEX_SE3:QUAT, EDGE_SE3:QUAT, VERTEX_SE2, EDGE_SE2 and FIX; lines that begin with anything else
// are counted and left out (landmarks). The first edge between a number and the next one that the
// file has is odometry, of one robot (GTSAM's keys: of one letter), and as many between two numbers
// as lines ODOMETRY name them; every other is a loop, and all where a line LOOP names the numbers.
// A file without a VERTEX of a pose: its nodes are those that edges name, laid out along these.
// An information with directions that are 0 (or below by rounding) is raised there to 1e-9 of its
// largest eigenvalue; a warning names the first line and counts them.
// Throws InputError naming file, line, value and what was expected: a number that is none, not
// finite or of a pose beyond 1e9, a line cut short, a quaternion that is no rotation, an
// information that is indefinite, an edge to a vertex that the file does not have, a vertex twice,
// a file without an edge, or with planar and spatial ones.
G2oGraph read_g2o(const std::filesystem::path& path);

// Information of `edge` for g2o's error instead of ours.
core::Matrix6d g2o_information(const PoseEdge& edge);

// Squared error of an edge as g2o has it, in variances: of a rotation by theta it takes 2 sin(theta
// / 2) where chi2_of takes theta. The same in the plane.
double g2o_chi2_of(const PoseGraph& graph, const PoseEdge& edge);

}  // namespace samewhere::optimize
