#pragma once

#include <string_view>

namespace samewhere::report {

// The report page without its data, with the libraries that it uses: made by cmake/EmbedPage.cmake
// from the files of page/. Stands where `{{title}}`, `{{live}}`, `{{run}}`, `{{pictures}}` and
// `{{durations}}` are, in this order, for what html.cpp puts there.
std::string_view page_template();

// The same of the page that compares runs, with `{{title}}`, `{{runs}}`, `{{judged}}` and
// `{{same_frames}}` (compare.cpp).
std::string_view compare_template();

}  // namespace samewhere::report
