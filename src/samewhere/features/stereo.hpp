#pragma once

#include <vector>

#include <opencv2/core/mat.hpp>

#include <samewhere/core/frame.hpp>
#include <samewhere/features/config.hpp>
#include <samewhere/features/features.hpp>

namespace samewhere::features {

// Whether depth comes from two cameras: the frame has two pictures, no depth of its own, and a
// calibration of both. Throws ContractError unless these are a rectified pair
// (core/rectified_pair.hpp).
bool is_stereo(const core::Frame& frame);

// Distance of the two pictures that right_x_px speaks of: of the second camera of the rig if there
// is one, else config.virtual_baseline_m. Metres.
double baseline_m(const core::Rig& rig, const Config& config);

// One picture of a pair: its pyramid and its features (raw_px, octave and descriptors are read).
struct Side {
  const std::vector<cv::Mat>& levels;
  const Features& features;
};

// Stereo matches: for each feature of the left image its position along its row in the right image,
// full-size pixels, NaN without a match. The most similar descriptor on the row, on the same or a
// neighbouring level and at a depth of at least two baselines, is refined by block matching in
// steps of a pixel of the level and a parabola through the differences. Matches whose block
// difference is far above the median are removed (Mur-Artal and Tardos 2017).
Array<float> match_stereo(const Side& left, const Side& right, const core::Rig& rig,
                          const Config& config);

}  // namespace samewhere::features
