#pragma once

#include <set>
#include <string>
#include <vector>

#include <samewhere/paper/runs.hpp>

namespace samewhere::paper {

// Tables of the published method that can be printed: 2 (AUC by number of draws), 3 (milliseconds),
// 6 (loops right and wrong).
using PaperTableNumbers = std::set<int>;

// "2,3". Throws InputError on anything but 2, 3 and 6.
PaperTableNumbers parse_table_numbers(const std::string& list);

// For the terminal: the wanted tables, one column for each number of draws, one for every queue
// ("all") and one for the exact search, means and standard deviations over the seeds, the published
// figures below ours.
std::string paper_text(const PaperBlock& block, const PaperTableNumbers& numbers);

// One row for each search: what it found, and which describer saw the views. As CSV.
std::string searches_csv(const std::vector<PaperBlock>& blocks);
// One row for each step of each block and number of draws, milliseconds a frame. As CSV.
std::string times_csv(const std::vector<PaperBlock>& blocks);

}  // namespace samewhere::paper
