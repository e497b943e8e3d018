#pragma once

#include <string>

#include <samewhere/report/record.hpp>

namespace samewhere::report {

// report.html: one page that needs nothing beside it, in light and dark, on a phone too. It shows
// the figures, the path, the state of each frame, the funnel of refusals, accepted and refused
// pairs with their thumbnails, and the config. Parts of which the record says nothing are left out.
// The same record gives the same bytes: durations are not on it.
std::string report_html(const RunRecord& record);

}  // namespace samewhere::report
