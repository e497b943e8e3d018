#pragma once

#include <cmath>
#include <optional>
#include <vector>

#include <opencv2/core/mat.hpp>

#include <samewhere/core/rig.hpp>
#include <samewhere/core/rigid3.hpp>
#include <samewhere/evaluate/depth_places.hpp>

namespace samewhere::bench {

using evaluate::DepthView;  // its depth is exact at every pixel

// Depth between the centres of pixels, by inverse depth, which is linear on a plane; nothing
// outside the picture and where surfaces meet.
std::optional<double> depth_between(const cv::Mat& depth_m, const Eigen::Vector2d& pixel);

// A pixel of one view carried to another by depth and pose.
struct CarriedPixel {
  Eigen::Vector2d from_px = Eigen::Vector2d::Zero();
  Eigen::Vector2d to_px = Eigen::Vector2d::Zero();
  double foretold_m = 0.0;  // depth of the point for the other view
  double seen_m = 0.0;      // that view's depth at to_px

  // Large where the point is hidden: the share of small ones among all tells a gross mistake, their
  // median a subtle one.
  double depth_residual() const { return std::abs(seen_m / foretold_m - 1.0); }
};

// Pixels so far apart, but those that fall outside the other view or on an edge.
std::vector<CarriedPixel> carried_pixels(const core::Camera& camera, const DepthView& from,
                                         const DepthView& to, int step_px);

}  // namespace samewhere::bench
