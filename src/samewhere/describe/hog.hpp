#pragma once

#include <vector>

#include <opencv2/core/mat.hpp>

namespace samewhere::describe {

inline constexpr int kHogNumBins = 9;        // orientations in [0, 180) degrees, 20 degrees each
inline constexpr int kHogCellsPerBlock = 2;  // a block is 2 x 2 cells, blocks overlap by one cell
inline constexpr float kHogMaxShare = 0.2F;  // L2-Hys: no bin counts for more of its block

// Histograms of oriented gradients of an 8-bit grey image (Dalal and Triggs, CVPR 2005), coarse
// enough to be stable under a small camera motion. Blocks row by row, within a block the cells row
// by row, within a cell the bins: length hog_length(). Unsigned gradients by [-1 0 1], votes by
// magnitude, interpolated between neighbouring bins and cells. Each block is brought to length 1 by
// L2-Hys, or less where its gradients are weak: to 0.7 at a mean magnitude of `weak_gradient` grey
// levels, to 0 where there is none. With weak_gradient 0 the noise of a bare wall counts like any
// edge. The image's sides are multiples of cell_px and at least two cells, or ContractError.
std::vector<float> hog(const cv::Mat& grey, int cell_px, double weak_gradient);

int hog_length(cv::Size image_px, int cell_px);

}  // namespace samewhere::describe
