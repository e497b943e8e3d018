#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <set>
#include <utility>

#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/optimize/g2o_file.hpp>

namespace samewhere::optimize {
namespace {

std::string text_of(const core::Rigid3& a_from_b, bool is_planar) {
  const Eigen::Vector3d& t = a_from_b.translation;
  const Eigen::Quaterniond& q = a_from_b.rotation;
  if (is_planar) return fmt::format("{} {} {}", t.x(), t.y(), core::log_so3(a_from_b.rotation).z());
  return fmt::format("{} {} {} {} {} {} {}", t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w());
}

template <class Matrix>
std::string upper_triangle(const Matrix& matrix) {
  std::string text;
  for (int row = 0; row < matrix.rows(); ++row) {
    for (int column = row; column < matrix.cols(); ++column)
      fmt::format_to(std::back_inserter(text), " {}", matrix(row, column));
  }
  return text;
}

// our error = [t - t_measured; log(R_measured' R)] = this * g2o's, to first order
core::Matrix6d ours_from_g2o(const PoseEdge& edge, bool is_planar) {
  core::Matrix6d matrix = core::Matrix6d::Zero();
  matrix.topLeftCorner<3, 3>() = edge.a_from_b.rotation.toRotationMatrix();
  matrix.bottomRightCorner<3, 3>() = (is_planar ? 1.0 : 2.0) * Eigen::Matrix3d::Identity();
  return matrix;
}

std::string information_text(const PoseEdge& edge, bool is_planar) {
  if (!is_planar) return upper_triangle(g2o_information(edge));
  const core::Matrix6d turned = ours_from_g2o(edge, true);
  const core::Matrix6d full = turned.transpose() * edge.information * turned;
  return upper_triangle(Eigen::Matrix3d(full(kPlanarRows, kPlanarRows)));
}

}  // namespace

core::Matrix6d g2o_information(const PoseEdge& edge) {
  const core::Matrix6d matrix = ours_from_g2o(edge, false);
  return matrix.transpose() * edge.information * matrix;
}

double g2o_chi2_of(const PoseGraph& graph, const PoseEdge& edge) {
  if (graph.is_planar) return chi2_of(graph, edge);
  core::Vector6d error = edge_error(edge, graph.world_from_node[static_cast<std::size_t>(edge.a)],
                                    graph.world_from_node[static_cast<std::size_t>(edge.b)]);
  const double angle = error.tail<3>().norm();
  if (angle > 1e-9) error.tail<3>() *= 2.0 * std::sin(0.5 * angle) / angle;
  return error.dot(edge.information * error);
}

std::vector<bool> nodes_with_edges(const PoseGraph& graph) {
  std::vector<bool> is_named(graph.world_from_node.size(), false);
  for (const PoseEdge& edge : graph.edges) {
    for (const int node : {edge.a, edge.b}) {
      core::require(node >= 0 && static_cast<std::size_t>(node) < is_named.size(),
                    "an edge joins nodes that are there");
      is_named[static_cast<std::size_t>(node)] = true;
    }
  }
  return is_named;
}

namespace {

using Ends = std::pair<int, int>;  // nodes of an edge, the lower first

// Between which a reader would take a loop for odometry: neighbours among the nodes that are
// written, without odometry.
std::set<Ends> loops_between_neighbours(const PoseGraph& graph, const std::vector<bool>& is_named) {
  std::vector<int> rank;
  int num_before = 0;
  for (const bool is_one : is_named) rank.push_back(is_one ? num_before++ : num_before);
  std::set<Ends> found;
  for (const PoseEdge& edge : graph.edges) {
    const Ends ends = std::minmax(edge.a, edge.b);
    const int apart =
        rank[static_cast<std::size_t>(ends.second)] - rank[static_cast<std::size_t>(ends.first)];
    if (edge.is_loop && apart == 1) found.insert(ends);
  }
  for (const PoseEdge& edge : graph.edges)
    if (!edge.is_loop) found.erase(std::minmax(edge.a, edge.b));
  return found;
}

}  // namespace

std::string g2o_text(const PoseGraph& graph, const std::vector<long>& names) {
  core::require(names.empty() || names.size() == graph.world_from_node.size(),
                "every node has a name, or none");
  const std::vector<bool> is_named = nodes_with_edges(graph);
  const auto name = [&](int node) {
    return names.empty() ? node : names[static_cast<std::size_t>(node)];
  };
  const char* const kind = graph.is_planar ? "SE2" : "SE3:QUAT";
  std::string text;
  for (std::size_t i = 0; i < is_named.size(); ++i) {
    if (!is_named[i]) continue;
    text += fmt::format("VERTEX_{} {} {}\n", kind, name(static_cast<int>(i)),
                        text_of(graph.world_from_node[i], graph.is_planar));
  }
  for (const int node : held_nodes(graph)) {
    if (is_named[static_cast<std::size_t>(node)]) text += fmt::format("FIX {}\n", name(node));
  }
  for (const auto& [a, b] : loops_between_neighbours(graph, is_named))
    text += fmt::format("{} {} {}\n", kG2oLoop, name(a), name(b));
  for (const PoseEdge& edge : graph.edges) {
    if (!edge.is_loop && std::abs(name(edge.a) - name(edge.b)) != 1)
      text += fmt::format("{} {} {}\n", kG2oOdometry, name(edge.a), name(edge.b));
    text += fmt::format("EDGE_{} {} {} {}{}\n", kind, name(edge.a), name(edge.b),
                        text_of(edge.a_from_b, graph.is_planar),
                        information_text(edge, graph.is_planar));
  }
  return text;
}

}  // namespace samewhere::optimize
