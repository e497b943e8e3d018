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

// Distribution of the corners: the config.num_features corners to keep. First the two strongest of
// each cell of the image, so that no part is left empty; then of each cell on each level the
// strongest in turn. A cell covers the same part of the image on each level: shares by the area of
// the levels match static images a little better, but coarse levels carry tracking under camera
// shake. Order: turn, strength, level, position.
std::vector<Corner> spread_evenly(std::vector<Corner> corners, const Config& config);

// The corner moved to the top of a parabola through the strengths around it, at most half a pixel
// along each axis. `image` is the level it was found on.
Corner with_subpixel(const cv::Mat& image, const Corner& corner);

}  // namespace samewhere::features
