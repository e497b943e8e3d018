#pragma once

#include <string>
#include <vector>

#include <samewhere/paper/results.hpp>
#include <samewhere/paper/tables.hpp>

namespace samewhere::paper {

// A figure of the page: an SVG file and what it shows.
struct PageFigure {
  std::string title;
  std::string svg;
};

// One page with all tables, the published figures in grey, what ran, what is missing, and the
// figures. Needs no network and no script. `command`: that makes it again.
std::string page_html(const Results& results, const std::vector<PaperTable>& tables,
                      const std::vector<PageFigure>& figures, const std::string& command);

}  // namespace samewhere::paper
