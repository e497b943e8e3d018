#pragma once

#include <string>

#include <samewhere/report/record.hpp>

namespace samewhere::report {

// An HTML figure: the path as SVG at equal scale, with scale bar, start and end, the truth dashed,
// the odometry before correction thin, accepted loops as lines between their frames, and a legend
// of what is drawn. Empty where no pose was measured.
std::string trajectory_figure(const RunRecord& record);

}  // namespace samewhere::report
