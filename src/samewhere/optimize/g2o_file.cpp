#include <iterator>
#include <vector>

#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/optimize/g2o_file.hpp>

namespace samewhere::optimize {
namespace {

std::string text_of(const core::Rigid3& a_from_b) {
  const Eigen::Vector3d& t = a_from_b.translation;
  const Eigen::Quaterniond& q = a_from_b.rotation;
  return fmt::format("{} {} {} {} {} {} {}", t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w());
}

std::string upper_triangle(const core::Matrix6d& matrix) {
  std::string text;
  for (int row = 0; row < 6; ++row) {
    for (int column = row; column < 6; ++column)
      fmt::format_to(std::back_inserter(text), " {}", matrix(row, column));
  }
  return text;
}

}  // namespace

core::Matrix6d g2o_information(const PoseEdge& edge) {
  // our error = [t - t_measured; log(R_measured' R)] = ours_from_g2o * g2o's, to first order
  core::Matrix6d ours_from_g2o = core::Matrix6d::Zero();
  ours_from_g2o.topLeftCorner<3, 3>() = edge.a_from_b.rotation.toRotationMatrix();
  ours_from_g2o.bottomRightCorner<3, 3>() = 2.0 * Eigen::Matrix3d::Identity();
  return ours_from_g2o.transpose() * edge.information * ours_from_g2o;
}

std::string g2o_text(const PoseGraph& graph) {
  std::vector<bool> is_named(graph.world_from_node.size(), false);
  for (const PoseEdge& edge : graph.edges) {
    for (const int node : {edge.a, edge.b}) {
      core::require(node >= 0 && static_cast<std::size_t>(node) < is_named.size(),
                    "an edge joins nodes that are there");
      is_named[static_cast<std::size_t>(node)] = true;
    }
  }
  std::string text;
  for (std::size_t i = 0; i < is_named.size(); ++i) {
    if (!is_named[i]) continue;
    text += fmt::format("VERTEX_SE3:QUAT {} {}\n", i, text_of(graph.world_from_node[i]));
  }
  text += fmt::format("FIX {}\n", graph.fixed_node);
  for (const PoseEdge& edge : graph.edges) {
    text += fmt::format("EDGE_SE3:QUAT {} {} {}{}\n", edge.a, edge.b, text_of(edge.a_from_b),
                        upper_triangle(g2o_information(edge)));
  }
  return text;
}

}  // namespace samewhere::optimize
