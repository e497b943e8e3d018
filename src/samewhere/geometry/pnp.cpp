#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include <samewhere/core/errors.hpp>
#include <samewhere/geometry/pnp.hpp>
#include <samewhere/geometry/polynomial.hpp>

namespace samewhere::geometry {
namespace {

using Triple = std::array<Eigen::Vector3d, 3>;

// The quantities of Grunert's solution, named as in the literature: sides a b c of the triangle
// opposite to points 1 2 3, cosines of the angles alpha beta gamma between the bearings that look
// at them.
struct Grunert {
  double a2, b2, c2;
  double cos_alpha, cos_beta, cos_gamma;
};

Grunert measure(const Triple& p, const Triple& f) {
  return {(p[1] - p[2]).squaredNorm(),
          (p[0] - p[2]).squaredNorm(),
          (p[0] - p[1]).squaredNorm(),
          f[1].dot(f[2]),
          f[0].dot(f[2]),
          f[0].dot(f[1])};
}

// Coefficients of the quartic in v = s3 / s1, constant first.
std::array<double, 5> quartic(const Grunert& g) {
  const double d = (g.a2 - g.c2) / g.b2;
  const double s = (g.a2 + g.c2) / g.b2;
  const double a_b = g.a2 / g.b2;
  const double c_b = g.c2 / g.b2;
  const double ca2 = g.cos_alpha * g.cos_alpha;
  const double cb2 = g.cos_beta * g.cos_beta;
  const double cg2 = g.cos_gamma * g.cos_gamma;
  const double ca_cg = g.cos_alpha * g.cos_gamma;
  return {(1.0 + d) * (1.0 + d) - 4.0 * a_b * cg2,
          4.0 * (-d * (1.0 + d) * g.cos_beta + 2.0 * a_b * cg2 * g.cos_beta - (1.0 - s) * ca_cg),
          2.0 * (d * d - 1.0 + 2.0 * d * d * cb2 + 2.0 * (1.0 - c_b) * ca2 -
                 4.0 * s * ca_cg * g.cos_beta + 2.0 * (1.0 - a_b) * cg2),
          4.0 * (d * (1.0 - d) * g.cos_beta - (1.0 - s) * ca_cg + 2.0 * c_b * ca2 * g.cos_beta),
          (d - 1.0) * (d - 1.0) - 4.0 * c_b * ca2};
}

// Distances to the three points for one root v; nothing if one would be negative.
std::optional<std::array<double, 3>> distances(const Grunert& g, double v) {
  const double d = (g.a2 - g.c2) / g.b2;
  const double divisor = 2.0 * (g.cos_gamma - v * g.cos_alpha);
  const double s1_squared = g.b2 / (1.0 + v * v - 2.0 * v * g.cos_beta);
  if (std::abs(divisor) < 1e-12 || !(s1_squared > 0.0)) return std::nullopt;
  const double u = ((d - 1.0) * v * v - 2.0 * d * g.cos_beta * v + 1.0 + d) / divisor;
  const double s1 = std::sqrt(s1_squared);
  if (!(u > 0.0) || !(v > 0.0)) return std::nullopt;
  return std::array<double, 3>{s1, u * s1, v * s1};
}

// Orthonormal axes fixed to a triangle; columns.
Eigen::Matrix3d triangle_axes(const Triple& p) {
  const Eigen::Vector3d x = (p[1] - p[0]).normalized();
  const Eigen::Vector3d z = x.cross(p[2] - p[0]).normalized();
  Eigen::Matrix3d axes;
  axes << x, z.cross(x), z;
  return axes;
}

struct PnpRansac {
  using Model = core::Rigid3;
  static constexpr int kSampleSize = 3;
  const PnpProblem& problem;

  int size() const { return static_cast<int>(problem.points_in_world.size()); }

  std::vector<Model> generate(const std::vector<int>& sample) const {
    Triple points;
    Triple bearings;
    for (std::size_t i = 0; i < 3; ++i) {
      points[i] = problem.points_in_world[static_cast<std::size_t>(sample[i])];
      bearings[i] = problem.bearings[static_cast<std::size_t>(sample[i])];
    }
    return solve_p3p(points, bearings);
  }

  double squared_error(const Model& camera_from_world, int i) const {
    const auto k = static_cast<std::size_t>(i);
    const Eigen::Vector3d point = camera_from_world * problem.points_in_world[k];
    if (point.z() <= 0.0) return std::numeric_limits<double>::infinity();
    const Eigen::Vector2d error = point.hnormalized() - problem.bearings[k].hnormalized();
    return problem.focal_px * problem.focal_px * error.squaredNorm();
  }
};

}  // namespace

std::vector<core::Rigid3> solve_p3p(const Triple& points_in_world, const Triple& bearings) {
  const Eigen::Vector3d side = points_in_world[1] - points_in_world[0];
  const double area = side.cross(points_in_world[2] - points_in_world[0]).norm();
  const Grunert g = measure(points_in_world, bearings);
  if (area < 1e-6 * (g.a2 + g.b2 + g.c2)) return {};

  const Eigen::Matrix3d world_axes = triangle_axes(points_in_world);
  std::vector<core::Rigid3> poses;
  for (const double v : real_roots(quartic(g))) {
    const auto s = distances(g, v);
    if (!s) continue;
    const Triple in_camera = {(*s)[0] * bearings[0], (*s)[1] * bearings[1], (*s)[2] * bearings[2]};
    const Eigen::Matrix3d rotation = triangle_axes(in_camera) * world_axes.transpose();
    if (!rotation.allFinite()) continue;
    poses.push_back(
        {Eigen::Quaterniond(rotation).normalized(), in_camera[0] - rotation * points_in_world[0]});
  }
  return poses;
}

std::optional<RansacResult<core::Rigid3>> estimate_pose(const PnpProblem& problem,
                                                        const RansacOptions& options,
                                                        core::Random& random) {
  core::require(problem.points_in_world.size() == problem.bearings.size(),
                "every point has one bearing");
  return ransac(PnpRansac{problem}, options, random);
}

}  // namespace samewhere::geometry
