#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <samewhere/geometry/camera.hpp>
#include <samewhere/optimize/manifold.hpp>
#include <samewhere/track/depth_alignment.hpp>

namespace samewhere::track {
namespace {

constexpr int kStep_px = 8;
constexpr double kConverged = 1e-5;

// Standard deviation of the distance of a point from a plane: grows with the square of the depth.
double sigma_m(double depth_m, const DepthAlignmentConfig& config) {
  return config.sigma_m + config.sigma_per_square_m * depth_m * depth_m;
}

struct Equations {
  core::Matrix6d hessian = core::Matrix6d::Zero();
  core::Vector6d gradient = core::Vector6d::Zero();
  core::Matrix6d directions = core::Matrix6d::Zero();  // the hessian were all patches as exact
  double weight = 0.0;                                 // of those
  double depth_m = 0.0;                                // sum over them
  int num_asked = 0;                                   // fall on a patch
  int num_inliers = 0;
};

Equations linearise(const Surfaces& earlier, const Surfaces& later, const core::Rigid3& pose,
                    double tukey, const DepthAlignmentConfig& config) {
  Equations sum;
  for (const Surfaces::Patch& patch : later.patches()) {
    if (patch.normal.isZero()) continue;
    const Eigen::Vector3d rotated = pose.rotation * patch.point;
    const Eigen::Vector3d point = rotated + pose.translation;
    const Surfaces::Patch* on = earlier.at(point);
    if (on == nullptr) continue;
    ++sum.num_asked;
    const Eigen::Vector3d misfit = point - on->point;
    const double residual = on->normal.dot(misfit) / sigma_m(patch.point.z(), config);
    if (std::abs(residual) >= tukey || misfit.norm() > config.max_distance_m) continue;
    ++sum.num_inliers;
    const double root = 1.0 - (residual / tukey) * (residual / tukey);
    core::Vector6d by_pose;
    by_pose << on->normal, rotated.cross(on->normal);
    sum.directions += root * root * by_pose * by_pose.transpose();
    sum.weight += root * root;
    sum.depth_m += root * root * patch.point.z();
    by_pose /= sigma_m(patch.point.z(), config);
    sum.hessian += root * root * by_pose * by_pose.transpose();
    sum.gradient += root * root * residual * by_pose;
  }
  return sum;
}

// That of one wall depends on the noise of its normals alone, and is no small covariance.
bool is_held(const Equations& sum, double min_eigenvalue) {
  core::Vector6d scale = core::Vector6d::Ones();
  scale.tail<3>().setConstant(sum.weight / sum.depth_m);
  const core::Matrix6d scaled =
      scale.asDiagonal() * sum.directions * scale.asDiagonal() / sum.weight;
  return Eigen::SelfAdjointEigenSolver<core::Matrix6d>(scaled, Eigen::EigenvaluesOnly)
             .eigenvalues()
             .minCoeff() > min_eigenvalue;
}

bool is_sure(const core::Matrix6d& covariance, const DepthAlignmentConfig& config) {
  const auto largest = [](const Eigen::Matrix3d& block) {
    return std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(block, Eigen::EigenvaluesOnly)
                         .eigenvalues()
                         .maxCoeff());
  };
  return largest(covariance.topLeftCorner<3, 3>()) < config.max_sigma_m &&
         largest(covariance.bottomRightCorner<3, 3>()) < config.max_sigma_rad;
}

// Metres along the optical axis, by the mean of the inverse depths, which are straight on a plane;
// 0: less than half is known, or it is an edge.
double depth_of_cell(const cv::Mat& depth_m, double max_step_ratio) {
  double sum = 0.0;
  double nearest_m = std::numeric_limits<double>::infinity();
  double farthest_m = 0.0;
  int count = 0;
  for (int y = 0; y < depth_m.rows; ++y) {
    const auto* row = depth_m.ptr<float>(y);
    for (int x = 0; x < depth_m.cols; ++x) {
      const auto z = static_cast<double>(row[x]);
      if (!(z > 0.0)) continue;
      nearest_m = std::min(nearest_m, z);
      farthest_m = std::max(farthest_m, z);
      sum += 1.0 / z;
      ++count;
    }
  }
  if (2 * count < depth_m.rows * depth_m.cols ||
      farthest_m - nearest_m > max_step_ratio * farthest_m)
    return 0.0;
  return count / sum;
}

}  // namespace

Surfaces::Surfaces(const cv::Mat& depth_m, const core::Camera& camera, double max_step_ratio)
    : camera_(camera),
      num_columns_(depth_m.cols / kStep_px),
      num_rows_(depth_m.rows / kStep_px),
      patches_(static_cast<std::size_t>(num_columns_) * static_cast<std::size_t>(num_rows_)) {
  for (int row = 0; row < num_rows_; ++row) {
    for (int column = 0; column < num_columns_; ++column) {
      const cv::Rect cell(column * kStep_px, row * kStep_px, kStep_px, kStep_px);
      const double z = depth_of_cell(depth_m(cell), max_step_ratio);
      if (z == 0.0) continue;
      constexpr double kMiddle_px = 0.5 * (kStep_px - 1);
      const Eigen::Vector3d ray =
          geometry::bearing(camera, Eigen::Vector2d(cell.x + kMiddle_px, cell.y + kMiddle_px));
      patches_[static_cast<std::size_t>(row * num_columns_ + column)].point = ray * (z / ray.z());
    }
  }
  add_normals(max_step_ratio);
}

void Surfaces::add_normals(double max_step_ratio) {
  const auto point = [&](int row, int column) -> const Eigen::Vector3d& {
    return patches_[static_cast<std::size_t>(row * num_columns_ + column)].point;
  };
  for (int row = 1; row + 1 < num_rows_; ++row) {
    for (int column = 1; column + 1 < num_columns_; ++column) {
      const double z = point(row, column).z();
      Eigen::Vector3d right = Eigen::Vector3d::Zero();
      Eigen::Vector3d down = Eigen::Vector3d::Zero();
      bool is_smooth = z > 0.0;
      for (int dy = -1; dy <= 1 && is_smooth; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
          const Eigen::Vector3d& beside = point(row + dy, column + dx);
          is_smooth =
              is_smooth && beside.z() > 0.0 && std::abs(beside.z() - z) < max_step_ratio * z;
          right += dx * beside;
          down += dy * beside;
        }
      }
      if (!is_smooth) continue;
      patches_[static_cast<std::size_t>(row * num_columns_ + column)].normal =
          right.cross(down).normalized();
    }
  }
}

const Surfaces::Patch* Surfaces::at(const Eigen::Vector3d& point_in_camera) const {
  const auto pixel = geometry::project(camera_, point_in_camera);
  if (!pixel) return nullptr;
  const int column = static_cast<int>(std::floor((pixel->x() + 0.5) / kStep_px));
  const int row = static_cast<int>(std::floor((pixel->y() + 0.5) / kStep_px));
  if (row < 0 || column < 0 || row >= num_rows_ || column >= num_columns_) return nullptr;
  const Patch& patch = patches_[static_cast<std::size_t>(row * num_columns_ + column)];
  return patch.normal.isZero() ? nullptr : &patch;
}

std::optional<Alignment> align(const Surfaces& earlier, const Surfaces& later,
                               const core::Rigid3& guessed_earlier_from_later,
                               const DepthAlignmentConfig& config) {
  core::Rigid3 pose = guessed_earlier_from_later;
  const int min_patches =
      static_cast<int>(config.min_patch_ratio * static_cast<double>(later.patches().size()));
  for (int i = 0; i < config.iterations; ++i) {
    const double tukey = std::max(config.tukey, config.first_tukey * std::pow(0.7, i));
    const Equations sum = linearise(earlier, later, pose, tukey, config);
    if (sum.num_inliers < min_patches) return std::nullopt;
    core::Matrix6d damped = sum.hessian;
    damped.diagonal().array() += 1e-6 * damped.diagonal().array().maxCoeff();
    const core::Vector6d step = damped.ldlt().solve(-sum.gradient);
    if (!step.allFinite()) return std::nullopt;
    pose = optimize::retract(pose, step);
    if (tukey == config.tukey && step.norm() < kConverged) break;
  }
  const Equations sum = linearise(earlier, later, pose, config.tukey, config);
  Alignment found{pose, {}, static_cast<double>(sum.num_inliers) / std::max(sum.num_asked, 1)};
  if (sum.num_inliers < min_patches || found.share_of_inliers < config.min_agreement ||
      !is_held(sum, config.min_eigenvalue))
    return std::nullopt;
  found.covariance =
      config.correlation * config.correlation * sum.hessian.llt().solve(core::Matrix6d::Identity());
  if (!found.covariance.allFinite() || !is_sure(found.covariance, config)) return std::nullopt;
  return found;
}

bool are_apart(const core::Rigid3& a, const core::Rigid3& b) {
  constexpr double kApart_m = 0.05;
  constexpr double kApart_rad = 0.03;
  const core::Rigid3 off = inverse(a) * b;
  return off.translation.norm() > kApart_m || core::angle_rad(off.rotation) > kApart_rad;
}

core::Matrix6d covariance_of_later(const Alignment& alignment,
                                   const core::Rigid3& later_from_reference) {
  const core::Rigid3 later_from_earlier = inverse(alignment.earlier_from_later);
  const Eigen::Matrix3d turned = later_from_earlier.rotation.toRotationMatrix();
  // where the reference is from the earlier camera, turned as the later one
  const Eigen::Vector3d arm = later_from_reference.translation - later_from_earlier.translation;
  core::Matrix6d by = core::Matrix6d::Zero();
  by.topLeftCorner<3, 3>() = -turned;
  by.bottomRightCorner<3, 3>() = -turned;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d axis = Eigen::Vector3d::Unit(i);
    by.col(3 + i).head<3>() =
        turned * axis.cross(alignment.earlier_from_later.translation) - (turned * axis).cross(arm);
  }
  return by * alignment.covariance * by.transpose();
}

}  // namespace samewhere::track
