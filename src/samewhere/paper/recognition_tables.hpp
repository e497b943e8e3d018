#pragma once

#include <vector>

#include <samewhere/paper/results.hpp>
#include <samewhere/paper/tables.hpp>

namespace samewhere::paper {

// Tables 2 to 5, and loops by recognition alone as a second Table 6.
std::vector<PaperTable> recognition_tables(const Results& results);

}  // namespace samewhere::paper
