#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <samewhere/verify/look_alike.hpp>

namespace samewhere::verify {
namespace {

// A displacement, and the information on it, in the eigenvectors of that information, the least
// certain direction first.
struct Displacement {
  Eigen::Vector3d information;  // ascending, 1/m^2
  Eigen::Vector3d expected;     // that would leave no error, m
};

Displacement displacement_of(const core::Vector6d& error, const core::Matrix6d& covariance) {
  const core::Matrix6d information = covariance.llt().solve(core::Matrix6d::Identity());
  const Eigen::Matrix3d of_position = information.topLeftCorner<3, 3>();
  const Eigen::Vector3d expected =
      error.head<3>() +
      of_position.llt().solve(information.topRightCorner<3, 3>() * error.tail<3>());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(of_position);
  return {solver.eigenvalues(), solver.eigenvectors().transpose() * expected};
}

// Nearest to the expected one among those of this length, at a Lagrange multiplier below the least
// information.
Eigen::Vector3d at_multiplier(const Displacement& displacement, double multiplier) {
  return displacement.information.cwiseProduct(displacement.expected)
      .cwiseQuotient((displacement.information.array() - multiplier).matrix());
}

// For an expected displacement shorter than the length. If it has no part in the least certain
// direction, that direction makes up the length.
Eigen::Vector3d nearest_of_length(const Displacement& displacement, double length_m) {
  constexpr int kIterations = 60;
  double low = 0.0;
  double high = displacement.information(0);
  for (int i = 0; i < kIterations; ++i) {
    const double middle = 0.5 * (low + high);
    (at_multiplier(displacement, middle).norm() < length_m ? low : high) = middle;
  }
  Eigen::Vector3d nearest = at_multiplier(displacement, low);
  const double missing = length_m * length_m - nearest.tail<2>().squaredNorm();
  nearest(0) = std::copysign(std::sqrt(std::max(0.0, missing)), displacement.expected(0));
  return nearest;
}

}  // namespace

double look_alike_gain(const core::Vector6d& error, const core::Matrix6d& covariance,
                       double distance_m) {
  const Displacement displacement = displacement_of(error, covariance);
  const auto chi_square = [&](const Eigen::Vector3d& at) {
    return displacement.information.dot((at - displacement.expected).cwiseAbs2());
  };
  const double of_place = chi_square(Eigen::Vector3d::Zero());
  if (displacement.expected.norm() >= distance_m) return -of_place;
  return chi_square(nearest_of_length(displacement, distance_m)) - of_place;
}

}  // namespace samewhere::verify
