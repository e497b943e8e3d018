#pragma once

#include <vector>

#include <samewhere/report/record.hpp>

namespace samewhere::app {

// Names and values in two aligned columns on stdout.
void print_figures(const std::vector<report::Figure>& figures);

}  // namespace samewhere::app
