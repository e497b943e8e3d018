#pragma once

#include <samewhere/core/rig.hpp>

namespace samewhere::twin {

// The camera of all walks: 640 x 480, 63 degrees wide, with a little distortion.
inline constexpr core::PinholeRadtan kTwinCamera = {.width_px = 640,
                                                    .height_px = 480,
                                                    .fx_px = 525.0,
                                                    .fy_px = 524.0,
                                                    .cx_px = 318.6,
                                                    .cy_px = 241.3,
                                                    .k1 = 0.05,
                                                    .k2 = -0.08,
                                                    .p1 = 0.0006,
                                                    .p2 = -0.0004,
                                                    .k3 = 0.0};

// From the left camera of a stereo pair to the right one.
inline constexpr double kStereoBaseline_m = 0.11;

}  // namespace samewhere::twin
