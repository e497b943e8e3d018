#include <algorithm>
#include <functional>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/evaluate/statistics.hpp>
#include <samewhere/paper/recognition_tables.hpp>
#include <samewhere/paper/slam_tables.hpp>
#include <samewhere/paper/tables.hpp>
#include <samewhere/report/table.hpp>

namespace samewhere::paper {
namespace {

constexpr int kFirstTable = 2;
constexpr int kLastTable = 8;

// "4" or "2-5" of a list.
std::pair<int, int> span_of(const std::string& word, const std::string& list) {
  const auto digit = [](char c) { return c >= '0' + kFirstTable && c <= '0' + kLastTable; };
  const bool is_one = word.size() == 1 && digit(word[0]);
  const bool is_span =
      word.size() == 3 && digit(word[0]) && word[1] == '-' && digit(word[2]) && word[0] <= word[2];
  if (!is_one && !is_span) {
    throw core::InputError(fmt::format(
        "--tables {}: there is no table \"{}\", expected some of {} to {}, such as 2,4-6", list,
        word, kFirstTable, kLastTable));
  }
  return {word.front() - '0', word.back() - '0'};
}

constexpr int kTableOfErrors = 7;

// The rows become columns: there are more methods than sequences.
PaperTable transposed(PaperTable table) {
  std::vector<std::string> header{table.header.front()};
  std::vector<PaperTable::Row> rows;
  for (std::size_t column = 1; column < table.header.size(); ++column)
    rows.push_back({{table.header[column]}, false});
  for (const PaperTable::Row& row : table.rows) {
    header.push_back(row.cells.front());
    for (std::size_t column = 1; column < row.cells.size(); ++column)
      rows[column - 1].cells.push_back(row.cells[column]);
    table.num_published_columns += row.is_published ? 1 : 0;
  }
  table.header = std::move(header);
  table.rows = std::move(rows);
  return table;
}

}  // namespace

PaperTableNumbers parse_table_numbers(const std::string& list) {
  PaperTableNumbers numbers;
  std::string word;
  for (const char c : list + ",") {
    if (c != ',') {
      word += c;
      continue;
    }
    const auto [first, last] = span_of(word, list);
    for (int number = first; number <= last; ++number) numbers.insert(number);
    word.clear();
  }
  return numbers;
}

std::vector<PaperTable> make_tables(const Results& results, const PaperTableNumbers& numbers) {
  std::vector<PaperTable> tables = recognition_tables(results);
  for (PaperTable& table : slam_tables(results)) tables.push_back(std::move(table));
  std::erase_if(tables, [&](const PaperTable& table) {
    return !numbers.contains(table.number) ||
           std::all_of(table.rows.begin(), table.rows.end(),
                       [](const PaperTable::Row& row) { return row.is_published; });
  });
  for (PaperTable& table : tables) {
    if (table.number != kTableOfErrors) table = transposed(std::move(table));
  }
  return tables;
}

std::string as_text(const PaperTable& table) {
  report::Table plain{table.header, {}};
  for (const PaperTable::Row& row : table.rows) plain.rows.push_back(row.cells);
  return fmt::format("Table {}: {}\n\n{}{}\n", table.number, table.title, report::as_text(plain),
                     table.note);
}

}  // namespace samewhere::paper
