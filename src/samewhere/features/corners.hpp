#pragma once

#include <vector>

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

#include <samewhere/features/config.hpp>

namespace samewhere::features {

// Corners keep this distance from the edges of their level: room for the patch that describes them.
inline constexpr int kBorder_px = 17;

// A corner on one level of a pyramid.
struct Corner {
  Eigen::Vector2f level_px = Eigen::Vector2f::Zero();
  int level = 0;
  float strength = 0.0F;  // smaller eigenvalue of the structure tensor around it
};

// The FAST corners (Rosten and Drummond 2006) of one level and how strong they are (Shi and Tomasi
// 1994), at whole pixels. Plain parts of the picture are searched a second time with the low
// contrast of the config.
std::vector<Corner> find_corners(const cv::Mat& image, int level, const Config& config);

// The config.num_features corners to keep: of each cell of the picture its two strongest, so that
// no part is left empty while another is crowded; then of each cell on each level its strongest in
// turn. A cell covers the same part of the picture on each level: shares by the area of the levels
// match still pictures a little better, but the coarse levels carry the tracking of a camera that
// shakes. In the order of turn, strength, level, position.
std::vector<Corner> spread_evenly(std::vector<Corner> corners, const Config& config);

// The corner moved to the top of a parabola through the strengths around it, at most half a pixel
// along each axis. `image` is the level it was found on.
Corner with_subpixel(const cv::Mat& image, const Corner& corner);

}  // namespace samewhere::features
