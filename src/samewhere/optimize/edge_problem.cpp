#include <algorithm>
#include <cmath>

#include <samewhere/core/errors.hpp>
#include <samewhere/optimize/edge_problem.hpp>
#include <samewhere/optimize/scaled_edge.hpp>

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

// Between nodes with units of their own.
class ScaledEdgeCost : public ceres::SizedCostFunction<7, 7, 7, 1, 1> {
 public:
  explicit ScaledEdgeCost(const PoseEdge& edge)
      : edge_(edge),
        whitening_(whitening(edge.information)),
        root_(std::sqrt(edge.scale_information)) {}

  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override {
    const ScaledNode a{from_block(blocks[0]), *blocks[2]};
    const ScaledNode b{from_block(blocks[1]), *blocks[3]};
    Eigen::Map<Vector7d> whitened(residuals);
    whitened = whitened_all(scaled_edge_error(edge_, a, b));
    if (jacobians == nullptr) return true;
    const ScaledEdgeJacobians derivatives = scaled_edge_jacobians(edge_, a, b);
    write_by_tangent<7>(whitened_all(derivatives.by_a), jacobians[0]);
    write_by_tangent<7>(whitened_all(derivatives.by_b), jacobians[1]);
    write_column(whitened_all(derivatives.by_scale_of_a), jacobians[2]);
    write_column(whitened_all(derivatives.by_scale_of_b), jacobians[3]);
    return true;
  }

 private:
  static void write_column(const Vector7d& column, double* out) {
    if (out != nullptr) std::copy(column.begin(), column.end(), out);
  }
  template <int Columns>
  Eigen::Matrix<double, 7, Columns> whitened_all(
      const Eigen::Matrix<double, 7, Columns>& rows) const {
    Eigen::Matrix<double, 7, Columns> out;
    out.template topRows<6>() = whitening_ * rows.template topRows<6>();
    out.template bottomRows<1>() = root_ * rows.template bottomRows<1>();
    return out;
  }

  PoseEdge edge_;
  core::Matrix6d whitening_;
  double root_;
};

// Weighs the squared error by the edge's weight at the time of evaluation.
class Weighted : public ceres::LossFunction {
 public:
  explicit Weighted(const double& weight) : weight_(weight) {}

  void Evaluate(double squared, double out[3]) const override {
    out[0] = weight_ * squared;
    out[1] = weight_;
    out[2] = 0.0;
  }

 private:
  const double& weight_;
};

// Dynamic covariance scaling as a loss: beyond `trusted` its slope is (2 t / (t + s))^2.
class DynamicScaling : public ceres::LossFunction {
 public:
  explicit DynamicScaling(double trusted) : trusted_(trusted) {}

  void Evaluate(double squared, double out[3]) const override {
    if (squared <= trusted_) {
      out[0] = squared;
      out[1] = 1.0;
      out[2] = 0.0;
      return;
    }
    const double sum = squared + trusted_;
    const double scale = 2.0 * trusted_ / sum;
    out[0] = trusted_ * (3.0 * squared - trusted_) / sum;
    out[1] = scale * scale;
    out[2] = -2.0 * scale * scale / sum;
  }

 private:
  double trusted_;
};

// The steps of a pose that stays in the plane, for blocks whose derivatives are laid out as
// PoseManifold has it.
class PlanarManifold : public ceres::Manifold {
 public:
  int AmbientSize() const override { return 7; }
  int TangentSize() const override { return 3; }

  bool Plus(const double* x, const double* delta, double* x_plus_delta) const override {
    const core::Vector6d full = in_space(delta);
    return whole_.Plus(x, full.data(), x_plus_delta);
  }

  bool PlusJacobian(const double* /*x*/, double* jacobian) const override {
    Eigen::Map<Eigen::Matrix<double, 7, 3, Eigen::RowMajor>> by_step(jacobian);
    by_step.setZero();
    for (std::size_t i = 0; i < kPlanarRows.size(); ++i)
      by_step(kPlanarRows[i], static_cast<Eigen::Index>(i)) = 1.0;
    return true;
  }

  bool Minus(const double* y, const double* x, double* y_minus_x) const override {
    core::Vector6d full;
    if (!whole_.Minus(y, x, full.data())) return false;
    for (std::size_t i = 0; i < kPlanarRows.size(); ++i) y_minus_x[i] = full(kPlanarRows[i]);
    return true;
  }

  bool MinusJacobian(const double* /*x*/, double* jacobian) const override {
    Eigen::Map<Eigen::Matrix<double, 3, 7, Eigen::RowMajor>> by_pose(jacobian);
    by_pose.setZero();
    for (std::size_t i = 0; i < kPlanarRows.size(); ++i)
      by_pose(static_cast<Eigen::Index>(i), kPlanarRows[i]) = 1.0;
    return true;
  }

 private:
  static core::Vector6d in_space(const double* delta) {
    core::Vector6d full = core::Vector6d::Zero();
    for (std::size_t i = 0; i < kPlanarRows.size(); ++i) full(kPlanarRows[i]) = delta[i];
    return full;
  }

  PoseManifold whole_;
};

ceres::Problem::Options problem_options() {
  ceres::Problem::Options options;
  options.enable_fast_removal = true;
  return options;
}

// One thread and EIGEN_SPARSE: with two threads, or with CHOLMOD, the last bits differ from run to
// run.
ceres::Solver::Options graph_solver_options(int max_iterations) {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.sparse_linear_algebra_library_type = ceres::EIGEN_SPARSE;
  options.num_threads = 1;
  options.max_num_iterations = max_iterations;
  // along a part without loops the cost is flat: a thousandth of it may be metres there
  options.function_tolerance = 1e-9;
  options.logging_type = ceres::SILENT;
  return options;
}

}  // namespace

EdgeProblem::EdgeProblem(PoseGraph& graph, const Config& config)
    : graph_(graph),
      config_(config),
      weights_(graph.edges.size(), 1.0),
      problem_(problem_options()),
      residuals_(graph.edges.size(), nullptr) {
  for (const auto& edge : graph.edges) {
    const auto is_node = [&](int node) {
      return node >= 0 && node < static_cast<int>(graph.world_from_node.size());
    };
    core::require(is_node(edge.a) && is_node(edge.b) && edge.a != edge.b,
                  "an edge joins two nodes of the graph");
  }
  const std::size_t num_nodes = graph.world_from_node.size();
  core::require(!has_scales(graph) || (graph.log_scales.size() == num_nodes && !graph.is_planar),
                "all nodes have a scale or none, and none in the plane");
  for (const auto& pose : graph.world_from_node) blocks_.push_back(to_block(pose));
  log_scales_ = graph.log_scales;
  for (auto& block : blocks_) {
    ceres::Manifold* const manifold = graph.is_planar
                                          ? static_cast<ceres::Manifold*>(new PlanarManifold)
                                          : static_cast<ceres::Manifold*>(new PoseManifold);
    problem_.AddParameterBlock(block.data(), 7, manifold);
  }
  for (double& log_scale : log_scales_) problem_.AddParameterBlock(&log_scale, 1);
  for (const int node : held_nodes(graph)) {
    const auto i = static_cast<std::size_t>(node);
    problem_.SetParameterBlockConstant(blocks_.at(i).data());
    if (has_scales(graph)) problem_.SetParameterBlockConstant(&log_scales_.at(i));
  }
}

ceres::LossFunction* EdgeProblem::loss_of(std::size_t edge) const {
  if (!graph_.edges[edge].is_loop) return nullptr;
  switch (config_.loop_loss) {
    case LoopLoss::kLeastSquares:
      return nullptr;
    case LoopLoss::kHuber:
      return new ceres::HuberLoss(config_.loop_huber);
    case LoopLoss::kDcs:
      return new DynamicScaling(config_.loop_dcs);
    case LoopLoss::kGnc:
    case LoopLoss::kGncEach:
      return new Weighted(weights_[edge]);
  }
  return nullptr;
}

void EdgeProblem::update_edges() {
  for (std::size_t i = 0; i < residuals_.size(); ++i) {
    const bool has_weight = weights_[i] > 0.0;
    if (has_weight == (residuals_[i] != nullptr)) continue;
    if (has_weight) {
      residuals_[i] = add_edge(i);
    } else {
      problem_.RemoveResidualBlock(residuals_[i]);
      residuals_[i] = nullptr;
    }
  }
}

ceres::ResidualBlockId EdgeProblem::add_edge(std::size_t i) {
  const PoseEdge& edge = graph_.edges[i];
  const auto a = static_cast<std::size_t>(edge.a);
  const auto b = static_cast<std::size_t>(edge.b);
  if (!has_scales(graph_))
    return problem_.AddResidualBlock(new EdgeCost(edge), loss_of(i), blocks_[a].data(),
                                     blocks_[b].data());
  return problem_.AddResidualBlock(new ScaledEdgeCost(edge), loss_of(i), blocks_[a].data(),
                                   blocks_[b].data(), &log_scales_[a], &log_scales_[b]);
}

void EdgeProblem::start_from_graph() {
  for (std::size_t i = 0; i < blocks_.size(); ++i) blocks_[i] = to_block(graph_.world_from_node[i]);
  std::copy(graph_.log_scales.begin(), graph_.log_scales.end(), log_scales_.begin());
}

PoseGraphSummary EdgeProblem::solve(int max_iterations) {
  if (graph_.edges.empty()) return {};
  update_edges();
  ceres::Solver::Summary summary;
  ceres::Solve(graph_solver_options(max_iterations), &problem_, &summary);
  core::require(summary.IsSolutionUsable(),
                "a pose graph of finite poses and edges has a solution");
  for (std::size_t i = 0; i < blocks_.size(); ++i) {
    graph_.world_from_node[i] = from_block(blocks_[i].data());
    graph_.world_from_node[i].rotation.normalize();
    blocks_[i] = to_block(graph_.world_from_node[i]);
  }
  graph_.log_scales = log_scales_;
  PoseGraphSummary done;
  done.initial_cost = summary.initial_cost;
  done.final_cost = summary.final_cost;
  done.num_iterations = std::max(0, static_cast<int>(summary.iterations.size()) - 1);
  done.has_converged = summary.termination_type == ceres::CONVERGENCE;
  return done;
}

}  // namespace samewhere::optimize
