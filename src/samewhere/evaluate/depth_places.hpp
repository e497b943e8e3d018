#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

#include <samewhere/core/rig.hpp>
#include <samewhere/core/rigid3.hpp>
#include <samewhere/core/truth.hpp>

namespace samewhere::evaluate {

// Depth along the optical axis, metres, and where it was seen from.
struct DepthView {
  cv::Mat depth_m;  // CV_32F, 0 where it is not known
  core::Rigid3 world_from_camera;
};

// Points of what the camera sees, in its frame, metres: on a grid of so many rows and columns,
// where the depth is known.
std::vector<Eigen::Vector3d> surface_points(const cv::Mat& depth_m, const core::Camera& camera,
                                            int grid);

// Share of the points of one view, 0 to 1, that another view sees: inside its image, as deep within
// 5 cm + 4 %. 0 with fewer than 30 points.
double share_seen(const std::vector<Eigen::Vector3d>& points, const core::Rigid3& other_from_view,
                  const cv::Mat& other_depth_m, const core::Camera& camera);

// Which frames show the same place, by protocol pr-v2 (docs/evaluation.md): same if either sees 30
// % of what the other does and their viewing directions are within 45 degrees; different below 5 %
// both ways; else near. Frames without depth or pose are near to all others. Time is quadratic in
// the number of frames.
core::PlaceTruthMatrix places_from_depth(const std::vector<std::optional<DepthView>>& frames,
                                         const core::Camera& camera);

}  // namespace samewhere::evaluate
