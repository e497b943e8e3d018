#pragma once

#include <set>
#include <string>
#include <vector>

#include <samewhere/paper/results.hpp>

namespace samewhere::paper {

// Tables of the published method: 2 and 3 (AUC and milliseconds by number of draws), 4 and 5 (the
// same by method), 6 to 8 (SLAM: loops right and wrong, trajectory error, frames per second).
using PaperTableNumbers = std::set<int>;

// "2,3" or "2-5,7". Throws InputError on anything but 2 to 8.
PaperTableNumbers parse_table_numbers(const std::string& list);

// A table as it is printed; every row has as many cells as the header.
struct PaperTable {
  struct Row {
    std::vector<std::string> cells;
    bool is_published = false;  // by the paper, of its own sequences
  };

  int number = 0;
  std::string title;
  std::vector<std::string> header;
  std::vector<Row> rows;
  std::string note;               // what the columns are, in sentences
  int num_published_columns = 0;  // the last ones, by the paper, of its own sequences
  bool is_more_better = false;    // the largest figure of a column leads
};

// Those of the wanted tables that have a row: means over the seeds, and the standard deviation
// behind them where there are several. The sequences are columns, ours before the published ones;
// in the table of trajectory errors they are rows.
std::vector<PaperTable> make_tables(const Results& results, const PaperTableNumbers& numbers);

// For the terminal.
std::string as_text(const PaperTable& table);

}  // namespace samewhere::paper
