#pragma once

#include <optional>
#include <vector>

#include <opencv2/core/mat.hpp>

#include <samewhere/core/rig.hpp>
#include <samewhere/core/rigid3.hpp>

namespace samewhere::track {

// The surfaces that a depth picture shows: a patch for every 8 x 8 pixels. The depths of its pixels
// and the planes of its neighbours are averaged, or noise would pass for structure.
class Surfaces {
 public:
  // depth_m: rows x columns of the camera's picture, 32-bit float, metres along the optical axis,
  // 0 = unknown.
  Surfaces(const cv::Mat& depth_m, const core::Camera& camera);

  struct Patch {
    Eigen::Vector3d point = Eigen::Vector3d::Zero();   // in the camera's frame, metres; z = 0: none
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();  // unit vector; zero: on an edge, or unknown
  };

  const std::vector<Patch>& patches() const { return patches_; }
  // The patch on which a point of the camera's frame lies; nullptr: none with a normal.
  const Patch* at(const Eigen::Vector3d& point_in_camera) const;

 private:
  void add_normals();

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

// How the camera moved between two depth pictures, without a feature: each patch of the later one
// is put on the plane of the patch of the earlier one that it falls on (point to plane, Chen and
// Medioni, IVC 1992; projective association, Blais and Levine, PAMI 1995), with Tukey's weights, so
// that what moves by itself is left out as long as the rest is more. Nothing if that leaves a
// direction open (one wall, a bare corridor), less than `min_share` agrees, or less than a
// sixteenth of the picture does.
std::optional<Alignment> align(const Surfaces& earlier, const Surfaces& later,
                               const core::Rigid3& guessed_earlier_from_later, double min_share);

// Whether two poses differ by more than a step that features refine: 5 cm or 0.03 rad.
bool are_apart(const core::Rigid3& a, const core::Rigid3& b);

// Of later_from_reference, by retract(), where earlier_from_reference is taken as known.
core::Matrix6d covariance_of_later(const Alignment& alignment,
                                   const core::Rigid3& later_from_reference);

}  // namespace samewhere::track
