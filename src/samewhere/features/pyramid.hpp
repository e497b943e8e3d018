#pragma once

#include <vector>

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

#include <samewhere/features/config.hpp>

namespace samewhere::features {

// A picture at full size and smaller and smaller, each level smaller than the one before by
// config.scale_factor. As many of config.num_levels as keep 64 pixels on each side; none if the
// picture itself is smaller. `grey` is 8-bit; level 0 is the picture itself, not a copy.
std::vector<cv::Mat> pyramid(const cv::Mat& grey, const Config& config);

// How much smaller than the picture each of config.num_levels is: 1, then larger and larger. Also
// how much less sure a place on that level is, in pixels of the picture.
std::vector<double> level_scales(const Config& config);

// Where a pixel of a level lies in the full picture. A level is resized between the outer edges of
// pixels, and a pixel's coordinates are those of its centre: half a pixel of difference that grows
// with the level.
Eigen::Vector2f full_from_level(const Eigen::Vector2f& level_px, const cv::Mat& level,
                                const cv::Mat& full);

// The other way round.
Eigen::Vector2f level_from_full(const Eigen::Vector2f& full_px, const cv::Mat& level,
                                const cv::Mat& full);

}  // namespace samewhere::features
