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

// For each feature of the left picture where it is along its row of the right one, full-size
// pixels, NaN where it was not found. The most similar descriptor on the row, on the same or a
// neighbouring level and no nearer than two baselines, says where to look; there the surroundings
// are compared at steps of a pixel of the level and a parabola placed through the differences.
// Matches whose surroundings differ by far more than the median pair's are taken out (Mur-Artal and
// Tardos 2017).
Array<float> match_stereo(const Side& left, const Side& right, const core::Rig& rig,
                          const Config& config);

}  // namespace samewhere::features
