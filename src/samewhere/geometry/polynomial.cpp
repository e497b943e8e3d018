#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

#include <samewhere/core/errors.hpp>
#include <samewhere/geometry/polynomial.hpp>

namespace samewhere::geometry {
namespace {

constexpr int kMaxDegree = 4;
using Companion = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxDegree, kMaxDegree>;

double evaluate(std::span<const double> c, double x) {
  double value = 0.0;
  for (auto i = c.size(); i-- > 0;) value = value * x + c[i];
  return value;
}

double evaluate_slope(std::span<const double> c, double x) {
  double value = 0.0;
  for (auto i = c.size(); i-- > 1;) value = value * x + static_cast<double>(i) * c[i];
  return value;
}

// Two Newton steps repair the digits that the eigenvalues lost.
double polished(std::span<const double> c, double x) {
  for (int i = 0; i < 2; ++i) {
    const double slope = evaluate_slope(c, x);
    if (std::abs(slope) > 0.0) x -= evaluate(c, x) / slope;
  }
  return x;
}

}  // namespace

std::vector<double> real_roots(std::span<const double> coefficients) {
  double largest = 0.0;
  for (const double c : coefficients) largest = std::max(largest, std::abs(c));
  while (!coefficients.empty() && std::abs(coefficients.back()) <= 1e-14 * largest) {
    coefficients = coefficients.first(coefficients.size() - 1);
  }
  const int degree = static_cast<int>(coefficients.size()) - 1;
  core::require(degree <= kMaxDegree, "real_roots takes polynomials up to degree 4");
  if (degree < 1) return {};

  Companion companion = Companion::Zero(degree, degree);
  for (int i = 1; i < degree; ++i) companion(i, i - 1) = 1.0;
  for (int i = 0; i < degree; ++i) {
    companion(i, degree - 1) = -coefficients[static_cast<std::size_t>(i)] / coefficients.back();
  }
  const Eigen::EigenSolver<Companion> solver(companion, false);
  std::vector<double> roots;
  for (int i = 0; i < degree; ++i) {
    const auto& root = solver.eigenvalues()(i);
    const bool is_real = std::abs(root.imag()) <= 1e-6 * (1.0 + std::abs(root.real()));
    if (is_real && std::isfinite(root.real())) roots.push_back(polished(coefficients, root.real()));
  }
  std::sort(roots.begin(), roots.end());
  return roots;
}

}  // namespace samewhere::geometry
