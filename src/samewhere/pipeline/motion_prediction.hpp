#pragma once

#include <samewhere/core/frame_pose.hpp>
#include <samewhere/scene/map_version.hpp>

namespace samewhere::pipeline {

// A metre in map units. A map without depth begins with a median depth of 1: about 3 m indoors.
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
  // Of the view at `stamp_s`, in the map of today. `metre`: in map units.
  MotionPrediction(const scene::MapVersion& map, const LastMotion& motion, double stamp_s,
                   double metre);

  // Whether the pose is inside the chi-square gate (6 degrees of freedom, 99 %).
  bool allows(const scene::MapVersion& map, const core::FramePose& pose) const;
  // Logarithm of a likelihood ratio, 0 or more: of the pose if the camera went on as before,
  // against a pose anywhere in the map, since look-alike places may be anywhere.
  double log_likelihood_ratio(const scene::MapVersion& map, const core::FramePose& pose) const;

 private:
  double chi_square(const scene::MapVersion& map, const core::FramePose& pose) const;

  bool is_known_ = false;
  core::Rigid3 world_from_body_;
  double sigma_ = 0.0;  // of each coordinate, map units
  double sigma_rad_ = 0.0;
  double walked_m_ = 0.0;  // what a person walks in the time lost
};

}  // namespace samewhere::pipeline
