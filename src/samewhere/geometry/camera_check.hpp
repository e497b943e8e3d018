#pragma once

#include <optional>
#include <string>

#include <samewhere/core/rig.hpp>

namespace samewhere::geometry {

// Numbers of a calibration outside these are a slip of the pen, a unit mistaken or a damaged file.
// Focal length as a share of the picture's longer side: a pinhole of 0.05 would see 169 degrees, a
// lens of 100 less than 0.6. Where the size of the pictures is not known, in pixels.
inline constexpr double kMinFocalLength_ratio = 0.05;
inline constexpr double kMaxFocalLength_ratio = 100.0;
inline constexpr double kMinFocalLength_px = 1.0;
inline constexpr double kMaxFocalLength_px = 1e6;
// Pixels of common sensors are square; of film and video formats twice as wide as high at most.
inline constexpr double kMaxFocalLengths_ratio = 4.0;
// Longer sides of pictures are rare: panoramas reach 30,000.
inline constexpr int kMaxPicture_px = 100000;
// Real lenses stay below 100; the rational model, of two polynomials that nearly cancel, below
// 1000.
inline constexpr double kMaxDistortion = 1e4;
// Cameras that make a pair are on one body.
inline constexpr double kMaxBaseline_m = 100.0;
// Where the distortion folds the picture, pixels have no direction. Calibrations in use lose their
// corners: that of TUM's first camera without its k3, as many tools give it, 12 %.
inline constexpr double kMaxFolded_ratio = 0.25;

// What makes these numbers no calibration, as a sentence with the number, what was expected and why
// ("k1 = 1e+200 folds ..."); nothing if they are one. The centre has to lie in the picture and
// pixels have to be seen from one direction each, where the size of the pictures is known.
std::optional<std::string> fault_of(const core::Camera& camera);

}  // namespace samewhere::geometry
