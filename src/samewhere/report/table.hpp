#pragma once

#include <string>
#include <vector>

namespace samewhere::report {

// Figures in rows; every row has as many cells as the header.
struct Table {
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;
};

// Columns padded to equal width, the first to the left, the others to the right; one line a row.
std::string as_text(const Table& table);

// Comma-separated, with quotes where a cell holds a comma or a quote (RFC 4180).
std::string as_csv(const Table& table);

}  // namespace samewhere::report
