#pragma once

#include <string>
#include <vector>

#include <samewhere/paper/runs.hpp>

namespace samewhere::paper {

// The precision-recall curves of one recording by each describer, as SVG: of the first seed with
// the published number of draws (or the most that were searched with, if it is not among them) and
// of the exact search, beside what the published method says of its own recordings.
std::string curves_svg(const std::vector<PaperBlock>& blocks_of_a_recording);

}  // namespace samewhere::paper
