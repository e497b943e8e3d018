#include "other_graph_solver.hpp"

#include <samewhere/core/errors.hpp>

#ifdef SAMEWHERE_BENCH_MRPT
#include <mrpt/graphs/CNetworkOfPoses.h>
#include <mrpt/graphslam/levmarq.h>
#include <mrpt/poses/CPose3D.h>
#include <mrpt/poses/CPose3DQuat.h>
#endif

namespace samewhere::bench {

#ifdef SAMEWHERE_BENCH_MRPT
namespace {

mrpt::poses::CPose3D as_mrpt(const core::Rigid3& pose) {
  const auto& t = pose.translation;
  const auto& q = pose.rotation;
  return mrpt::poses::CPose3D(mrpt::math::CQuaternionDouble(q.w(), q.x(), q.y(), q.z()), t.x(),
                              t.y(), t.z());
}

core::Rigid3 as_ours(const mrpt::poses::CPose3D& pose) {
  const mrpt::poses::CPose3DQuat found(pose);
  const auto& q = found.quat();
  return {Eigen::Quaterniond(q.r(), q.x(), q.y(), q.z()), {found.x(), found.y(), found.z()}};
}

// Until convergence: ten times its default iterations, and a step limit a million times smaller
// than its default.
constexpr std::size_t kMaxIterations = 1000;
constexpr double kSmallestStep = 1e-12;

template <class Network>
void solve(Network& network) {
  network.root = 0;
  mrpt::graphslam::TResultInfoSpaLevMarq outcome;
  mrpt::containers::yaml until = mrpt::containers::yaml::Map();
  until["max_iterations"] = kMaxIterations;
  until["e2"] = kSmallestStep;
  mrpt::graphslam::optimize_graph_spa_levmarq(network, outcome, nullptr, until);
}

void solve_in_space(optimize::PoseGraph& graph) {
  mrpt::graphs::CNetworkOfPoses3DInf network;
  for (std::size_t i = 0; i < graph.world_from_node.size(); ++i)
    network.nodes[i] = as_mrpt(graph.world_from_node[i]);
  for (const auto& edge : graph.edges) {
    mrpt::poses::CPose3DPDFGaussianInf measured(as_mrpt(edge.a_from_b));
    for (int row = 0; row < 6; ++row)
      for (int column = 0; column < 6; ++column)
        measured.cov_inv(row, column) = edge.information(row, column);
    network.insertEdge(static_cast<std::size_t>(edge.a), static_cast<std::size_t>(edge.b),
                       measured);
  }
  solve(network);
  for (std::size_t i = 0; i < graph.world_from_node.size(); ++i)
    graph.world_from_node[i] = as_ours(network.nodes[i]);
}

mrpt::poses::CPose2D in_plane(const core::Rigid3& pose) {
  return {pose.translation.x(), pose.translation.y(), core::log_so3(pose.rotation).z()};
}

void solve_in_plane(optimize::PoseGraph& graph) {
  mrpt::graphs::CNetworkOfPoses2DInf network;
  for (std::size_t i = 0; i < graph.world_from_node.size(); ++i)
    network.nodes[i] = in_plane(graph.world_from_node[i]);
  for (const auto& edge : graph.edges) {
    mrpt::poses::CPosePDFGaussianInf measured(in_plane(edge.a_from_b));
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 3; ++column)
        measured.cov_inv(row, column) =
            edge.information(optimize::kPlanarRows[static_cast<std::size_t>(row)],
                             optimize::kPlanarRows[static_cast<std::size_t>(column)]);
    network.insertEdge(static_cast<std::size_t>(edge.a), static_cast<std::size_t>(edge.b),
                       measured);
  }
  solve(network);
  for (std::size_t i = 0; i < graph.world_from_node.size(); ++i) {
    const auto& found = network.nodes[i];
    graph.world_from_node[i] = {core::exp_so3({0.0, 0.0, found.phi()}),
                                {found.x(), found.y(), 0.0}};
  }
}

}  // namespace

bool has_other_graph_solver() { return true; }

void solve_with_other(optimize::PoseGraph& graph) {
  graph.is_planar ? solve_in_plane(graph) : solve_in_space(graph);
}

#else

bool has_other_graph_solver() { return false; }

void solve_with_other(optimize::PoseGraph& /*graph*/) {
  throw core::ContractError("the other solver of pose graphs is part of this build");
}

#endif

}  // namespace samewhere::bench
