#pragma once

#include <vector>

#include <samewhere/paper/results.hpp>
#include <samewhere/paper/tables.hpp>

namespace samewhere::paper {

// Tables 6 to 8.
std::vector<PaperTable> slam_tables(const Results& results);

}  // namespace samewhere::paper
