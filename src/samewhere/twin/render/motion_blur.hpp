#pragma once

#include <opencv2/core/mat.hpp>

#include <samewhere/core/rig.hpp>
#include <samewhere/core/rigid3.hpp>
#include <samewhere/twin/render/renderer.hpp>

namespace samewhere::twin {

// How a camera moves, in its own axes.
struct CameraMotion {
  Eigen::Vector3d velocity_m_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular_velocity_rad_s = Eigen::Vector3d::Zero();
};

// Steady motion that takes it from one pose to the next.
CameraMotion motion_between(const core::Rigid3& world_from_first,
                            const core::Rigid3& world_from_second, double duration_s);

// The radiance that reaches each pixel while the shutter is open, the view being the middle of that
// time: a mean along the path of what the pixel sees in a picture of things at rest, at most 15
// pixels long (the motion field of Longuet-Higgins and Prazdny 1980; lens distortion bends it by a
// few per cent, which is left out). CV_32FC3.
cv::Mat blur_by_motion(const View& view, const core::Camera& camera, const CameraMotion& motion,
                       double exposure_s);

}  // namespace samewhere::twin
