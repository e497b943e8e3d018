#include <cmath>
#include <vector>

#include <Eigen/SVD>
#include <Eigen/SparseCholesky>

#include <samewhere/core/errors.hpp>
#include <samewhere/optimize/chordal.hpp>

namespace samewhere::optimize {
namespace {

// A linear least-squares problem over one block of D rows per node, with any number of columns:
// residuals X_b - M X_a, some nodes known.
class BlockProblem {
 public:
  // The blocks of `values` (nodes below each other) at held nodes are known.
  BlockProblem(int block_rows, const std::vector<bool>& is_held, Eigen::MatrixXd values)
      : rows_(block_rows), values_(std::move(values)) {
    for (const bool held : is_held) place_.push_back(held ? -1 : num_free_++);
    right_side_ = Eigen::MatrixXd::Zero(Eigen::Index{rows_} * num_free_, values_.cols());
  }

  // Adds weight * |X_b - from_a X_a - offset|^2.
  void add(const PoseEdge& edge, double weight, const Eigen::MatrixXd& from_a,
           const Eigen::MatrixXd& offset) {
    const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(rows_, rows_);
    add_row_of(edge.a, edge.b, weight * from_a.transpose(), from_a, offset);
    // the other side of the same residual: X_a's part seen from b, with the signs turned
    const int b = place_[static_cast<std::size_t>(edge.b)];
    if (b < 0) return;
    add_block(b, b, weight * identity);
    right_side(b) += weight * offset;
    add_coupling(b, edge.a, weight * from_a);
  }

  // The solution, nodes below each other, known ones as they were.
  Eigen::MatrixXd solve() {
    const Eigen::Index size = right_side_.rows();
    if (size == 0) return values_;
    Eigen::SparseMatrix<double> normal(size, size);
    normal.setFromTriplets(entries_.begin(), entries_.end());
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(normal);
    if (factor.info() != Eigen::Success) return values_;
    const Eigen::MatrixXd free = factor.solve(right_side_);
    if (!free.allFinite()) return values_;
    for (std::size_t i = 0; i < place_.size(); ++i)
      if (place_[i] >= 0)
        values_.middleRows(rows_ * static_cast<Eigen::Index>(i), rows_) =
            free.middleRows(Eigen::Index{rows_} * place_[i], rows_);
    return values_;
  }

 private:
  Eigen::Block<Eigen::MatrixXd, Eigen::Dynamic, Eigen::Dynamic> right_side(int place) {
    return right_side_.block(Eigen::Index{rows_} * place, 0, rows_, right_side_.cols());
  }

  // Row of a: weight (M' M X_a - M' X_b + M' offset); `weighed` is weight M'.
  void add_row_of(int node_a, int node_b, const Eigen::MatrixXd& weighed,
                  const Eigen::MatrixXd& from_a, const Eigen::MatrixXd& offset) {
    const int a = place_[static_cast<std::size_t>(node_a)];
    if (a < 0) return;
    add_block(a, a, weighed * from_a);
    right_side(a) -= weighed * offset;
    add_coupling(a, node_b, weighed);
  }

  // Moves -matrix X_other of a row to where it belongs.
  void add_coupling(int row, int other, const Eigen::MatrixXd& matrix) {
    const int column = place_[static_cast<std::size_t>(other)];
    if (column < 0) {
      right_side(row) += matrix * values_.middleRows(Eigen::Index{rows_} * other, rows_);
    } else {
      add_block(row, column, -matrix);
    }
  }

  void add_block(int row, int column, const Eigen::MatrixXd& matrix) {
    for (int i = 0; i < rows_; ++i) {
      for (int j = 0; j < rows_; ++j)
        entries_.emplace_back(rows_ * row + i, rows_ * column + j, matrix(i, j));
    }
  }

  int rows_;
  int num_free_ = 0;
  Eigen::MatrixXd values_;
  std::vector<int> place_;  // of a node among the free ones; -1: held
  std::vector<Eigen::Triplet<double>> entries_;
  Eigen::MatrixXd right_side_;
};

std::vector<bool> is_held(const PoseGraph& graph) {
  std::vector<bool> held(graph.world_from_node.size(), false);
  for (const int node : held_nodes(graph)) held.at(static_cast<std::size_t>(node)) = true;
  return held;
}

Eigen::Quaterniond nearest_rotation(const Eigen::Matrix3d& matrix) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d u = svd.matrixU();
  if ((u * svd.matrixV().transpose()).determinant() < 0.0) u.col(2) = -u.col(2);
  return Eigen::Quaterniond(Eigen::Matrix3d(u * svd.matrixV().transpose())).normalized();
}

// Blocks are node_from_world: node_from_world_b = b_from_a node_from_world_a.
void place_rotations(PoseGraph& graph) {
  const int size = graph.is_planar ? 2 : 3;
  const auto as_matrix = [&](const Eigen::Quaterniond& rotation) {
    return Eigen::MatrixXd(rotation.toRotationMatrix().topLeftCorner(size, size));
  };
  const auto num_nodes = static_cast<Eigen::Index>(graph.world_from_node.size());
  Eigen::MatrixXd start(size * num_nodes, size);
  for (Eigen::Index i = 0; i < num_nodes; ++i)
    start.middleRows(size * i, size) =
        as_matrix(graph.world_from_node[static_cast<std::size_t>(i)].rotation.conjugate());
  BlockProblem problem(size, is_held(graph), std::move(start));
  const Eigen::MatrixXd none = Eigen::MatrixXd::Zero(size, size);
  for (const PoseEdge& edge : graph.edges) {
    const double weight = graph.is_planar
                              ? edge.information(5, 5)
                              : edge.information.bottomRightCorner<3, 3>().trace() / 3.0;
    problem.add(edge, weight, as_matrix(edge.a_from_b.rotation.conjugate()), none);
  }
  const Eigen::MatrixXd relaxed = problem.solve();
  const std::vector<bool> held = is_held(graph);
  for (Eigen::Index i = 0; i < num_nodes; ++i) {
    if (held[static_cast<std::size_t>(i)]) continue;
    Eigen::Matrix3d matrix = Eigen::Matrix3d::Identity();
    matrix.topLeftCorner(size, size) = relaxed.middleRows(size * i, size).transpose();
    if (graph.is_planar) {  // the nearest turn about z
      const double angle = std::atan2(matrix(1, 0) - matrix(0, 1), matrix(0, 0) + matrix(1, 1));
      graph.world_from_node[static_cast<std::size_t>(i)].rotation =
          core::exp_so3({0.0, 0.0, angle});
    } else {
      graph.world_from_node[static_cast<std::size_t>(i)].rotation = nearest_rotation(matrix);
    }
  }
}

// Blocks are positions, one row each: t_b = t_a + R_a t_ab.
void place_positions(PoseGraph& graph) {
  const auto num_nodes = static_cast<Eigen::Index>(graph.world_from_node.size());
  Eigen::MatrixXd start(num_nodes, 3);
  for (Eigen::Index i = 0; i < num_nodes; ++i)
    start.row(i) = graph.world_from_node[static_cast<std::size_t>(i)].translation.transpose();
  BlockProblem problem(1, is_held(graph), std::move(start));
  const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(1, 1);
  for (const PoseEdge& edge : graph.edges) {
    const double weight = graph.is_planar ? edge.information.topLeftCorner<2, 2>().trace() / 2.0
                                          : edge.information.topLeftCorner<3, 3>().trace() / 3.0;
    const Eigen::Vector3d step = graph.world_from_node[static_cast<std::size_t>(edge.a)].rotation *
                                 edge.a_from_b.translation;
    problem.add(edge, weight, identity, step.transpose());
  }
  const Eigen::MatrixXd placed = problem.solve();
  for (Eigen::Index i = 0; i < num_nodes; ++i)
    graph.world_from_node[static_cast<std::size_t>(i)].translation = placed.row(i).transpose();
}

}  // namespace

void place_by_chordal_relaxation(PoseGraph& graph) {
  core::require(!has_scales(graph), "the nodes of the graph share one unit");
  for (const PoseEdge& edge : graph.edges) {
    const auto is_node = [&](int node) {
      return node >= 0 && static_cast<std::size_t>(node) < graph.world_from_node.size();
    };
    core::require(is_node(edge.a) && is_node(edge.b), "an edge joins nodes that are there");
  }
  place_rotations(graph);
  place_positions(graph);
}

}  // namespace samewhere::optimize
