#pragma once

#include <string>

#include <samewhere/report/record.hpp>

namespace samewhere::report {

// report.html: one self-contained page, in light and dark, for phones too. It shows the metrics,
// the trajectory, the tracking status of each frame, the verification funnel, accepted and rejected
// candidates with thumbnails, and the configuration. Parts without data are left out. The same
// record gives the same bytes: durations are not on it.
std::string report_html(const RunRecord& record);

}  // namespace samewhere::report
