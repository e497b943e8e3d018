#pragma once

#include <string_view>

namespace samewhere::report {

// The style sheet of report.html: light and dark by the reader's setting, no outside resource.
std::string_view style_sheet();

}  // namespace samewhere::report
