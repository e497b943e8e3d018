#pragma once

#include <string_view>

namespace samewhere::report {

// The report page without its data, with the libraries that it uses: made by cmake/EmbedPage.cmake
// from the files of page/. Stands where `{{title}}`, `{{run}}`, `{{pictures}}` and `{{durations}}`
// are, in this order, for what html.cpp puts there.
std::string_view page_template();

}  // namespace samewhere::report
