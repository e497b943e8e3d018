#pragma once

#include <string>
#include <vector>

#include <samewhere/report/record.hpp>

namespace samewhere::report {

// HTML: a timeline of the frames coloured by tracking status, and the number of frames of each.
// Empty without frames.
std::string status_strip(const std::vector<FrameRecord>& frames);

}  // namespace samewhere::report
