#pragma once

#include <cstdint>

#include <samewhere/twin/render/renderer.hpp>

namespace samewhere::twin {

// A depth camera with structured light: 0.3 to 8 m, noise of 0.0015 z^2 m, steps of an eighth of a
// pixel of disparity (Khoshelham and Elberink, Sensors 2012), and holes: at grazing angles, beside
// edges, on lamps and windows. The result is a whole number of 1/5000 m, as 16-bit files keep it;
// 0 = no measurement. CV_32F, metres.
cv::Mat measure_depth(const View& view, const Building& building, std::uint64_t seed);

}  // namespace samewhere::twin
