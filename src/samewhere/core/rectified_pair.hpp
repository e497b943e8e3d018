#pragma once

#include <string>

#include <samewhere/core/result.hpp>
#include <samewhere/core/rig.hpp>

namespace samewhere::core {

// How far apart the first two cameras are, metres, if they show a point in the same row of both
// pictures, further left in the second: no distortion, the same size and intrinsics, the same
// directions, the second displaced along x only. Files round: rows may differ by a tenth of a
// pixel. Otherwise what is in the way, as the end of a sentence.
Result<double, std::string> rectified_baseline_m(const Rig& rig);

// Whether there is such a baseline.
bool is_rectified_pair(const Rig& rig);

}  // namespace samewhere::core
