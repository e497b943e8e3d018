#pragma once

#include <optional>
#include <vector>

#include <opencv2/core/mat.hpp>

#include <samewhere/core/rig.hpp>
#include <samewhere/core/rigid3.hpp>

namespace samewhere::bench {

// Depth along the optical axis, metres, exact at every pixel, and where it was seen from.
struct DepthView {
  cv::Mat depth_m;  // CV_32F
  core::Rigid3 world_from_camera;
};

// Depth between the centres of pixels, by inverse depth, which is linear on a plane; nothing
// outside the picture and where surfaces meet.
std::optional<double> depth_between(const cv::Mat& depth_m, const Eigen::Vector2d& pixel);

// |seen / foretold - 1| for a grid of pixels of one view, carried to another by depth and pose:
// foretold is how far away the point is from there, seen is the other view's depth at that pixel.
// Points that fall outside or on an edge have none; hidden ones do, and a large one: the share of
// small residuals tells a gross mistake, their median a subtle one.
std::vector<double> depth_residuals(const core::Camera& camera, const DepthView& from,
                                    const DepthView& to);

}  // namespace samewhere::bench
