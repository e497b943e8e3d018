#pragma once

#include <opencv2/core/types.hpp>

#include <samewhere/geometry/two_view.hpp>

namespace samewhere::verify {

// Of either picture so much lies in the other, the smaller share of both, in [0, 1], where the
// first is laid onto the second by the similarity that most of the pairs agree on: about how much
// of what one view shows the other shows, too. Exact for a camera that turns about its axis or
// walks up to a wall, rough where what it sees has depth. 0 for fewer than 4 pairs.
double overlap_ratio(const geometry::PixelPairs& pairs, const cv::Size& first_size_px,
                     const cv::Size& second_size_px);

}  // namespace samewhere::verify
