#pragma once

#include <optional>
#include <vector>

#include <opencv2/core/mat.hpp>

#include <samewhere/core/rig.hpp>
#include <samewhere/core/rigid3.hpp>
#include <samewhere/track/config.hpp>

namespace samewhere::track {

// The nearest surface in each cell of a depth picture.
class NearestSurface {
 public:
  // depth_m: rows x columns of the camera's picture, 32-bit float, metres along the optical axis,
  // 0 = unknown.
  NearestSurface(const cv::Mat& depth_m, const core::Camera& camera,
                 const FreeSpaceConfig& config = {});

  // Whether the picture saw something well behind the point (in its camera's frame, metres): then
  // nothing was there when it was taken. Not where it shows nothing, or something as near in a cell
  // beside it.
  bool sees_through(const Eigen::Vector3d& point_in_camera) const;

 private:
  core::Camera camera_;
  FreeSpaceConfig config_;  // margins: errors of depth, of the pose, and at the edge of an object
  cv::Mat nearest_m_;       // a cell each; 0: unknown
};

}  // namespace samewhere::track
