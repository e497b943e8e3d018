#include <algorithm>

#include <fmt/format.h>

#include <samewhere/core/csv.hpp>
#include <samewhere/report/table.hpp>

namespace samewhere::report {
namespace {

using Row = std::vector<std::string>;

std::vector<std::size_t> column_widths(const Table& table) {
  std::vector<std::size_t> widths(table.header.size(), 0);
  const auto widen = [&widths](const Row& row) {
    for (std::size_t i = 0; i < row.size() && i < widths.size(); ++i) {
      widths[i] = std::max(widths[i], row[i].size());
    }
  };
  widen(table.header);
  std::for_each(table.rows.begin(), table.rows.end(), widen);
  return widths;
}

std::string text_line(const Row& row, const std::vector<std::size_t>& widths) {
  std::string line = fmt::format("{:<{}}", row.front(), widths.front());
  for (std::size_t i = 1; i < row.size(); ++i) line += fmt::format("  {:>{}}", row[i], widths[i]);
  return line + "\n";
}

std::string csv_line(const Row& row) {
  std::string line;
  for (std::size_t i = 0; i < row.size(); ++i) {
    if (i > 0) line += ',';
    line += core::csv_field(row[i]);
  }
  return line + "\n";
}

}  // namespace

std::string as_text(const Table& table) {
  const std::vector<std::size_t> widths = column_widths(table);
  std::string text = text_line(table.header, widths);
  for (const Row& row : table.rows) text += text_line(row, widths);
  return text;
}

std::string as_csv(const Table& table) {
  std::string text = csv_line(table.header);
  for (const Row& row : table.rows) text += csv_line(row);
  return text;
}

}  // namespace samewhere::report
