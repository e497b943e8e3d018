#include <samewhere/core/errors.hpp>
#include <samewhere/optimize/pose_block.hpp>
#include <samewhere/optimize/pose_graph.hpp>

namespace samewhere::optimize {
namespace {

class EdgeCost : public ceres::SizedCostFunction<6, 7, 7> {
 public:
  explicit EdgeCost(const PoseEdge& edge) : edge_(edge), whitening_(whitening(edge.information)) {}

  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override {
    const core::Rigid3 world_from_a = from_block(blocks[0]);
    const core::Rigid3 world_from_b = from_block(blocks[1]);
    Eigen::Map<core::Vector6d> whitened(residuals);
    whitened = whitening_ * edge_error(edge_, world_from_a, world_from_b);
    if (jacobians == nullptr) return true;
    const EdgeJacobians derivatives = edge_jacobians(edge_, world_from_a, world_from_b);
    write_by_tangent<6>(whitening_ * derivatives.by_a, jacobians[0]);
    write_by_tangent<6>(whitening_ * derivatives.by_b, jacobians[1]);
    return true;
  }

 private:
  PoseEdge edge_;
  core::Matrix6d whitening_;
};

// One thread and EIGEN_SPARSE: with two threads, or with CHOLMOD, the last bits differ from run to
// run.
ceres::Solver::Options solver_options(const Config& config) {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.sparse_linear_algebra_library_type = ceres::EIGEN_SPARSE;
  options.num_threads = 1;
  options.max_num_iterations = config.graph_iterations;
  options.logging_type = ceres::SILENT;
  return options;
}

void add_edges(ceres::Problem& problem, const PoseGraph& graph, std::vector<PoseBlock>& blocks,
               const Config& config) {
  for (const auto& edge : graph.edges) {
    const auto is_node = [&](int i) { return i >= 0 && i < static_cast<int>(blocks.size()); };
    core::require(is_node(edge.a) && is_node(edge.b) && edge.a != edge.b,
                  "an edge joins two nodes of the graph");
    ceres::LossFunction* loss = edge.is_loop ? new ceres::HuberLoss(config.loop_huber) : nullptr;
    problem.AddResidualBlock(new EdgeCost(edge), loss,
                             blocks[static_cast<std::size_t>(edge.a)].data(),
                             blocks[static_cast<std::size_t>(edge.b)].data());
  }
}

}  // namespace

core::Vector6d edge_error(const PoseEdge& edge, const core::Rigid3& world_from_a,
                          const core::Rigid3& world_from_b) {
  const core::Rigid3 a_from_b = inverse(world_from_a) * world_from_b;
  core::Vector6d error;
  error << a_from_b.translation - edge.a_from_b.translation,
      core::log_so3(edge.a_from_b.rotation.conjugate() * a_from_b.rotation);
  return error;
}

EdgeJacobians edge_jacobians(const PoseEdge& edge, const core::Rigid3& world_from_a,
                             const core::Rigid3& world_from_b) {
  const Eigen::Matrix3d a_from_world = world_from_a.rotation.conjugate().toRotationMatrix();
  const Eigen::Matrix3d b_from_world = world_from_b.rotation.conjugate().toRotationMatrix();
  const Eigen::Vector3d offset = world_from_b.translation - world_from_a.translation;
  const Eigen::Vector3d rotation_error = edge_error(edge, world_from_a, world_from_b).tail<3>();
  const Eigen::Matrix3d rotation_by_b = right_jacobian_inverse(rotation_error) * b_from_world;

  EdgeJacobians jacobians{core::Matrix6d::Zero(), core::Matrix6d::Zero()};
  jacobians.by_a.topLeftCorner<3, 3>() = -a_from_world;
  jacobians.by_a.topRightCorner<3, 3>() = a_from_world * core::skew(offset);
  jacobians.by_a.bottomRightCorner<3, 3>() = -rotation_by_b;
  jacobians.by_b.topLeftCorner<3, 3>() = a_from_world;
  jacobians.by_b.bottomRightCorner<3, 3>() = rotation_by_b;
  return jacobians;
}

PoseGraphSummary solve_pose_graph(PoseGraph& graph, const Config& config) {
  std::vector<PoseBlock> blocks;
  blocks.reserve(graph.world_from_node.size());
  for (const auto& pose : graph.world_from_node) blocks.push_back(to_block(pose));

  ceres::Problem problem;
  for (auto& block : blocks) problem.AddParameterBlock(block.data(), 7, new PoseManifold);
  add_edges(problem, graph, blocks, config);
  if (blocks.empty() || graph.edges.empty()) return {};
  problem.SetParameterBlockConstant(blocks.at(static_cast<std::size_t>(graph.fixed_node)).data());

  ceres::Solver::Summary summary;
  ceres::Solve(solver_options(config), &problem, &summary);
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    graph.world_from_node[i] = from_block(blocks[i].data());
    graph.world_from_node[i].rotation.normalize();
  }
  return {summary.initial_cost, summary.final_cost, static_cast<int>(summary.iterations.size())};
}

}  // namespace samewhere::optimize
