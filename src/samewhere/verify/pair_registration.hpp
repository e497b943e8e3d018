#pragma once

#include <optional>

#include <Eigen/Core>
#include <opencv2/core/types.hpp>

#include <samewhere/core/random.hpp>
#include <samewhere/geometry/two_view.hpp>

namespace samewhere::verify {

// How one picture lies on another.
struct Registration {
  Eigen::Matrix3d second_from_first = Eigen::Matrix3d::Identity();  // homogeneous pixels
  bool is_homography = false;                                       // false: a similarity
};

// Where a pixel lies under it; infinity behind the horizon.
Eigen::Vector2d mapped(const Eigen::Matrix3d& to_from, const Eigen::Vector2d& pixel);

// The similarity of least squares (after Umeyama 1991, in the plane), fitted anew to the better
// half of the pairs for some rounds. Nothing for pairs of one point, or none.
std::optional<Registration> register_by_similarity(const geometry::PixelPairs& pairs,
                                                   int num_rounds = 1);

// The homography that most pairs agree on (estimate_homography), within a fiftieth of the picture's
// width: a corridor is no plane. If there is none, or if it turns over, tears or shears the part of
// the picture around the pairs: the similarity of least squares (after Umeyama 1991, in the plane),
// fitted again without the pairs that it explains worst. Nothing for fewer than 8 pairs, or pairs
// of one point.
std::optional<Registration> register_pictures(const geometry::PixelPairs& pairs,
                                              const cv::Size& size_px, core::Random& random);

}  // namespace samewhere::verify
