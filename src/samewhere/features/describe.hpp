#pragma once

#include <array>
#include <cstdint>

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

namespace samewhere::features {

inline constexpr int kDescriptorBytes = 32;
// Of the disc around a corner that is looked at.
inline constexpr int kPatchRadius_px = 15;

// Direction from a pixel to the centre of brightness of the disc of 15 pixels around it (Rosin
// 1999), clockwise from the x axis, radians. `image` is one level of a pyramid; the disc must lie
// within it.
float orientation_rad(const cv::Mat& image, const Eigen::Vector2f& pixel);

// Steered BRIEF (Rublee et al. 2011): the comparisons of pattern.hpp, turned by the orientation.
// `blurred` is the level after blurred_for_descriptors; `descriptor` has room for kDescriptorBytes.
void describe(const cv::Mat& blurred, const Eigen::Vector2f& pixel, float angle_rad,
              std::uint8_t* descriptor);

// Smoothed, so that a comparison is not one of noise.
cv::Mat blurred_for_descriptors(const cv::Mat& image);

}  // namespace samewhere::features
