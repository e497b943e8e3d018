#pragma once

#include <string>

#include <samewhere/report/record.hpp>

namespace samewhere::report {

// An HTML figure: the trajectory as SVG at equal scale, with scale bar, start and end, ground truth
// dashed, odometry thin, accepted loops as lines between their frames, and a legend. Empty where no
// pose was measured.
std::string trajectory_figure(const RunRecord& record);

}  // namespace samewhere::report
