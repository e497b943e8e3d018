#pragma once

#include <optional>
#include <vector>

#include <opencv2/core/mat.hpp>

#include <samewhere/core/rig.hpp>
#include <samewhere/core/rigid3.hpp>
#include <samewhere/track/config.hpp>

namespace samewhere::track {

// The surfaces that a depth picture shows: a patch for every 8 x 8 pixels. The depths of its pixels
// and the planes of its neighbours are averaged, or noise would pass for structure.
class Surfaces {
 public:
  // depth_m: rows x columns of the camera's picture, 32-bit float, metres along the optical axis,
  // 0 = unknown. Depths that differ by a larger share than max_step_ratio are two surfaces.
  Surfaces(const cv::Mat& depth_m, const core::Camera& camera,
           double max_step_ratio = DepthAlignmentConfig{}.max_step_ratio);

  struct Patch {
    Eigen::Vector3d point = Eigen::Vector3d::Zero();   // in the camera's frame, metres; z = 0: none
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();  // unit vector; zero: on an edge, or unknown
  };

  const std::vector<Patch>& patches() const { return patches_; }
  // The patch on which a point of the camera's frame lies; nullptr: none with a normal.
  const Patch* at(const Eigen::Vector3d& point_in_camera) const;

 private:
  void add_normals(double max_step_ratio);

  core::Camera camera_;
  int num_columns_ = 0;
  int num_rows_ = 0;
  std::vector<Patch> patches_;  // row by row
};

struct Alignment {
  core::Rigid3 earlier_from_later;                         // of the camera
  core::Matrix6d covariance = core::Matrix6d::Identity();  // by retract()
  // of the patches of the later picture that fall on one of the other, both with a normal
  double share_of_inliers = 0.0;
};

// Motion of the camera between two depth images, without features: point to plane (Chen and
// Medioni, IVC 1992) with projective association (Blais and Levine, PAMI 1995) and Tukey weights,
// so that moving objects are outliers while they are the minority. Nothing if a direction is
// undetermined (one wall, a bare corridor), or if fewer patches agree than `config` asks for.
std::optional<Alignment> align(const Surfaces& earlier, const Surfaces& later,
                               const core::Rigid3& guessed_earlier_from_later,
                               const DepthAlignmentConfig& config);

// Whether two poses differ by more than a step that features refine: 5 cm or 0.03 rad.
bool are_apart(const core::Rigid3& a, const core::Rigid3& b);

// Of later_from_reference, by retract(), where earlier_from_reference is taken as known.
core::Matrix6d covariance_of_later(const Alignment& alignment,
                                   const core::Rigid3& later_from_reference);

}  // namespace samewhere::track
