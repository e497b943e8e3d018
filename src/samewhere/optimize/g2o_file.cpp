#include <cstdlib>
#include <iterator>

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
