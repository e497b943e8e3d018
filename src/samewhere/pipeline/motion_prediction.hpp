#pragma once

#include <samewhere/core/frame_pose.hpp>
#include <samewhere/scene/map_version.hpp>
#include <samewhere/verify/config.hpp>

namespace samewhere::pipeline {

// A metre in map units. A map without depth, unless odometry gives its scale, begins with a median
// depth of 1: about 3 m indoors.
double metre_of(const scene::MapVersion& map);

// The last motion of a camera before it was lost: two measured frames, one after the other. Either
// may be nullptr.
struct LastMotion {
  const core::FramePose* last = nullptr;
  const core::FramePose* before = nullptr;
};

// Where a lost camera is if it went on as before: constant velocity, with a covariance that grows
// with the time lost. Motion is evidence that a look-alike place would not give.
class MotionPrediction {
 public:
  // Of the view at `stamp_s`, in the map of today.
  MotionPrediction(const scene::MapVersion& map, const LastMotion& motion, double stamp_s,
                   const verify::Config& config);

  // Whether the pose is inside the chi-square gate (6 degrees of freedom, 99 %).
  bool allows(const scene::MapVersion& map, const core::FramePose& pose) const;
  // Logarithm of a likelihood ratio, 0 or more: of this place against the most likely look-alike
  // of it, which is as far away as loops assume (verify/look_alike.hpp). The camera may have been
  // carried off, so motion never speaks against a place.
  double log_likelihood_ratio(const scene::MapVersion& map, const core::FramePose& pose) const;

 private:
  core::Vector6d error(const scene::MapVersion& map, const core::FramePose& pose) const;
  core::Matrix6d covariance() const;

  bool is_known_ = false;
  core::Rigid3 world_from_body_;
  double sigma_ = 0.0;  // of each coordinate, map units
  double sigma_rad_ = 0.0;
  Eigen::Vector3d last_position_ = Eigen::Vector3d::Zero();  // world
  double reach_ = 0.0;           // from there in the time lost, map units
  double least_distance_ = 0.0;  // of a look-alike, map units
};

}  // namespace samewhere::pipeline
