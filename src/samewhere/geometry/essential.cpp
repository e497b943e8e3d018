#include <cmath>

#include <Eigen/Dense>

#include <samewhere/core/errors.hpp>
#include <samewhere/geometry/camera.hpp>
#include <samewhere/geometry/essential.hpp>
#include <samewhere/geometry/two_view.hpp>

namespace samewhere::geometry {
namespace {

// Polynomials in x, y, z by their coefficients. The ten monomials of degree 3 come first, then x^2,
// xy, xz, y^2, yz, z^2, x, y, z, 1: a quadratic has the last ten, a linear one the last four.
using Linear = Eigen::Vector4d;
using Quadratic = Eigen::Matrix<double, 10, 1>;
using Cubic = Eigen::Matrix<double, 20, 1>;

constexpr int kNumMonomials = 20;
constexpr int kFirstQuadratic = 10;
constexpr int kFirstLinear = 16;
constexpr std::array<std::array<int, 3>, kNumMonomials> kExponents = {
    {{3, 0, 0}, {2, 1, 0}, {2, 0, 1}, {1, 2, 0}, {1, 1, 1}, {1, 0, 2}, {0, 3, 0},
     {0, 2, 1}, {0, 1, 2}, {0, 0, 3}, {2, 0, 0}, {1, 1, 0}, {1, 0, 1}, {0, 2, 0},
     {0, 1, 1}, {0, 0, 2}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}}};

using ProductTable = std::array<std::array<int, 4>, kNumMonomials>;

// kProduct[m][l]: which monomial m times x, y, z or 1 is, -1 above degree 3.
constexpr ProductTable product_table() {
  ProductTable table{};
  for (std::size_t m = 0; m < kNumMonomials; ++m) {
    for (std::size_t l = 0; l < 4; ++l) {
      std::array<int, 3> product = kExponents[m];
      if (l < 3) ++product[l];
      table[m][l] = -1;
      for (std::size_t k = 0; k < kNumMonomials; ++k) {
        if (kExponents[k] == product) table[m][l] = static_cast<int>(k);
      }
    }
  }
  return table;
}

constexpr ProductTable kProduct = product_table();

Quadratic product(const Linear& a, const Linear& b) {
  Quadratic result = Quadratic::Zero();
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      const int k =
          kProduct[static_cast<std::size_t>(kFirstLinear + i)][static_cast<std::size_t>(j)];
      result(k - kFirstQuadratic) += a(i) * b(j);
    }
  }
  return result;
}

Cubic product(const Quadratic& a, const Linear& b) {
  Cubic result = Cubic::Zero();
  for (int i = 0; i < 10; ++i) {
    for (int j = 0; j < 4; ++j) {
      const int k =
          kProduct[static_cast<std::size_t>(kFirstQuadratic + i)][static_cast<std::size_t>(j)];
      result(k) += a(i) * b(j);
    }
  }
  return result;
}

// A 3 x 3 matrix of polynomials.
template <class Polynomial>
using MatrixOf = std::array<std::array<Polynomial, 3>, 3>;

// E = x E0 + y E1 + z E2 + E3 by entries, where E0 to E3 span the matrices that fit the five pairs.
MatrixOf<Linear> fitting_matrices(const RayPairs& five) {
  Eigen::Matrix<double, 5, 9> rows;
  for (int i = 0; i < 5; ++i) {
    const Eigen::Vector3d& a = five.first[static_cast<std::size_t>(i)];
    const Eigen::Vector3d& b = five.second[static_cast<std::size_t>(i)];
    rows.row(i) << b.x() * a.transpose(), b.y() * a.transpose(), b.z() * a.transpose();
  }
  // the columns of Q beyond the fifth are orthogonal to all rows
  const Eigen::Matrix<double, 9, 9> q =
      Eigen::Matrix<double, 9, 5>(rows.transpose()).householderQr().householderQ();
  MatrixOf<Linear> e;
  for (int i = 0; i < 9; ++i) {
    e[static_cast<std::size_t>(i / 3)][static_cast<std::size_t>(i % 3)] =
        q.block<1, 4>(i, 5).transpose();
  }
  return e;
}

// det(E), expanded by the first row.
Cubic determinant(const MatrixOf<Linear>& e) {
  const auto minor = [&](std::size_t j, std::size_t k) {
    return Quadratic(product(e[1][j], e[2][k]) - product(e[1][k], e[2][j]));
  };
  return product(minor(1, 2), e[0][0]) - product(minor(0, 2), e[0][1]) +
         product(minor(0, 1), e[0][2]);
}

// E E' - trace(E E') / 2, symmetric.
MatrixOf<Quadratic> traceless_square(const MatrixOf<Linear>& e) {
  MatrixOf<Quadratic> square;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      square[i][j] =
          product(e[i][0], e[j][0]) + product(e[i][1], e[j][1]) + product(e[i][2], e[j][2]);
    }
  }
  const Quadratic half_trace = 0.5 * (square[0][0] + square[1][1] + square[2][2]);
  for (std::size_t i = 0; i < 3; ++i) square[i][i] -= half_trace;
  return square;
}

// What makes a matrix essential: det(E) = 0 and (E E' - trace(E E') / 2) E = 0, one row each.
Eigen::Matrix<double, 10, 20> constraints(const MatrixOf<Linear>& e) {
  Eigen::Matrix<double, 10, 20> rows;
  rows.row(9) = determinant(e).transpose();
  const MatrixOf<Quadratic> square = traceless_square(e);
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      rows.row(static_cast<Eigen::Index>(3 * i + j)) =
          (product(square[i][0], e[0][j]) + product(square[i][1], e[1][j]) +
           product(square[i][2], e[2][j]))
              .transpose();
    }
  }
  return rows;
}

// Multiplication by x of the ten lower monomials, once the cubic ones are written by them.
Eigen::Matrix<double, 10, 10> action_matrix(const Eigen::Matrix<double, 10, 20>& rows) {
  const Eigen::Matrix<double, 10, 10> by_lower =
      -rows.leftCols<10>().partialPivLu().solve(rows.rightCols<10>());
  Eigen::Matrix<double, 10, 10> action = Eigen::Matrix<double, 10, 10>::Zero();
  for (int i = 0; i < 10; ++i) {
    const int up = kProduct[static_cast<std::size_t>(kFirstQuadratic + i)][0];
    if (up < kFirstQuadratic) {
      action.row(i) = by_lower.row(up);
    } else {
      action(i, up - kFirstQuadratic) = 1.0;
    }
  }
  return action;
}

double sampson_squared_px(const Eigen::Matrix3d& essential, const RayPairs& pairs, std::size_t k) {
  return pairs.focal_px * pairs.focal_px *
         sampson_squared(essential, pairs.first[k].hnormalized(), pairs.second[k].hnormalized());
}

struct EssentialRansac {
  using Model = Eigen::Matrix3d;
  static constexpr int kSampleSize = 5;
  const RayPairs& pairs;

  int size() const { return pairs.size(); }
  std::vector<Model> generate(const std::vector<int>& sample) const {
    return solve_essential_5(subset(pairs, sample));
  }
  double squared_error(const Model& essential, int i) const {
    return sampson_squared_px(essential, pairs, static_cast<std::size_t>(i));
  }
};

using Matrix5d = Eigen::Matrix<double, 5, 5>;
using Vector5d = Eigen::Matrix<double, 5, 1>;

// Two unit vectors at right angles to a unit vector and to each other; columns.
Eigen::Matrix<double, 3, 2> tangents_of(const Eigen::Vector3d& direction) {
  const Eigen::Vector3d first = direction.unitOrthogonal();
  Eigen::Matrix<double, 3, 2> tangents;
  tangents << first, direction.cross(first);
  return tangents;
}

// The step (rotation; translation along its tangents) that lowers the Sampson distances, whose
// denominators count as constant.
Vector5d gauss_newton_step(const RayPairs& pairs, const core::Rigid3& second_from_first,
                           const Eigen::Matrix<double, 3, 2>& tangents) {
  constexpr double kHuber_px = 1.0;
  const Eigen::Matrix3d essential = essential_of(second_from_first);
  const Eigen::Vector3d& t = second_from_first.translation;
  Matrix5d hessian = Matrix5d::Zero();
  Vector5d gradient = Vector5d::Zero();
  for (std::size_t k = 0; k < pairs.first.size(); ++k) {
    const Eigen::Vector3d a = pairs.first[k] / pairs.first[k].z();
    const Eigen::Vector3d b = pairs.second[k] / pairs.second[k].z();
    const Eigen::Vector3d turned = second_from_first.rotation * a;
    const double norm =
        std::hypot((essential * a).head<2>().norm(), (essential.transpose() * b).head<2>().norm());
    if (norm == 0.0) continue;
    const double to_px = pairs.focal_px / norm;
    const double error_px = to_px * t.dot(turned.cross(b));
    Vector5d slope;
    slope << to_px * turned.cross(b.cross(t)), to_px * tangents.transpose() * turned.cross(b);
    const double weight = std::abs(error_px) < kHuber_px ? 1.0 : kHuber_px / std::abs(error_px);
    hessian += weight * slope * slope.transpose();
    gradient += weight * error_px * slope;
  }
  hessian.diagonal().array() += 1e-9 * hessian.diagonal().maxCoeff();
  return hessian.ldlt().solve(-gradient);
}

}  // namespace

std::vector<Eigen::Matrix3d> solve_essential_5(const RayPairs& five) {
  core::require(five.first.size() == 5 && five.second.size() == 5,
                "the 5-point method takes five pairs");
  const MatrixOf<Linear> e = fitting_matrices(five);
  const Eigen::Matrix<double, 10, 10> action = action_matrix(constraints(e));
  if (!action.allFinite()) return {};
  const Eigen::EigenSolver<Eigen::Matrix<double, 10, 10>> eigen(action);
  std::vector<Eigen::Matrix3d> solutions;
  for (int i = 0; i < 10; ++i) {
    if (eigen.eigenvalues()(i).imag() != 0.0) continue;
    const Eigen::Matrix<double, 10, 1> monomials = eigen.eigenvectors().col(i).real();
    const Linear xyz1 = monomials.tail<4>() / monomials(9);
    Eigen::Matrix3d essential;
    for (std::size_t row = 0; row < 3; ++row) {
      for (std::size_t column = 0; column < 3; ++column) {
        essential(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(column)) =
            e[row][column].dot(xyz1);
      }
    }
    if (essential.allFinite()) solutions.emplace_back(essential.normalized());
  }
  return solutions;
}

TransferError epipolar_error(const Eigen::Matrix3d& essential, const RayPairs& pairs, int i) {
  const auto k = static_cast<std::size_t>(i);
  const Eigen::Vector3d a = pairs.first[k] / pairs.first[k].z();
  const Eigen::Vector3d b = pairs.second[k] / pairs.second[k].z();
  const double error_px = pairs.focal_px * b.dot(essential * a);
  return {error_px * error_px / (essential.transpose() * b).head<2>().squaredNorm(),
          error_px * error_px / (essential * a).head<2>().squaredNorm()};
}

std::optional<RansacResult<Eigen::Matrix3d>> estimate_essential(const RayPairs& pairs,
                                                                const RansacOptions& options,
                                                                core::Random& random) {
  core::require(pairs.first.size() == pairs.second.size(), "rays come in pairs");
  return ransac(EssentialRansac{pairs}, options, random);
}

Eigen::Matrix3d essential_from_fundamental(const Eigen::Matrix3d& fundamental,
                                           const core::Camera& first, const core::Camera& second) {
  return calibration_matrix(second).transpose() * fundamental * calibration_matrix(first);
}

std::array<core::Rigid3, 4> motions_of_essential(const Eigen::Matrix3d& essential) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(essential, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d u = svd.matrixU();
  Eigen::Matrix3d v = svd.matrixV();
  if (u.determinant() < 0.0) u = -u;
  if (v.determinant() < 0.0) v = -v;
  Eigen::Matrix3d quarter_turn;
  quarter_turn << 0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0;
  const Eigen::Quaterniond one(Eigen::Matrix3d(u * quarter_turn * v.transpose()));
  const Eigen::Quaterniond other(Eigen::Matrix3d(u * quarter_turn.transpose() * v.transpose()));
  const Eigen::Vector3d t = u.col(2);
  return {core::Rigid3{one.normalized(), t}, core::Rigid3{one.normalized(), -t},
          core::Rigid3{other.normalized(), t}, core::Rigid3{other.normalized(), -t}};
}

Eigen::Matrix3d essential_of(const core::Rigid3& second_from_first) {
  return core::skew(second_from_first.translation) * second_from_first.rotation.toRotationMatrix();
}

core::Rigid3 refine_motion(const RayPairs& pairs, const core::Rigid3& second_from_first) {
  constexpr int kMaxIterations = 20;
  constexpr double kConverged = 1e-9;
  core::require(pairs.size() >= 5, "a motion is refined on five pairs or more");
  core::Rigid3 motion{second_from_first.rotation, second_from_first.translation.normalized()};
  for (int i = 0; i < kMaxIterations; ++i) {
    const Eigen::Matrix<double, 3, 2> tangents = tangents_of(motion.translation);
    const Vector5d step = gauss_newton_step(pairs, motion, tangents);
    if (!step.allFinite()) break;
    motion.rotation = (core::exp_so3(step.head<3>()) * motion.rotation).normalized();
    motion.translation = (motion.translation + tangents * step.tail<2>()).normalized();
    if (step.norm() < kConverged) break;
  }
  return motion;
}

}  // namespace samewhere::geometry
