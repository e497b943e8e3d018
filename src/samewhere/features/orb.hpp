#pragma once

#include <samewhere/features/config.hpp>
#include <samewhere/features/features.hpp>

namespace samewhere::features {

// ORB features (Rublee et al. 2011) of the first picture of a frame, spread evenly, with depth
// where the frame has it or its second picture tells it. A picture without corners, or smaller than
// 64 pixels on a side, has none. Throws ContractError if two calibrated pictures are no rectified
// pair (stereo.hpp).
View extract(const core::Frame& frame, const Config& config);

}  // namespace samewhere::features
