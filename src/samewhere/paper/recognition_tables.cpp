#include <algorithm>
#include <array>
#include <functional>
#include <set>
#include <string>

#include <fmt/format.h>

#include <samewhere/paper/published.hpp>
#include <samewhere/paper/recognition_tables.hpp>
#include <samewhere/paper/table_cells.hpp>

namespace samewhere::paper {
namespace {

constexpr const char* kPublishedMethodName = "paper";

using FigureOf = std::function<double(const RecognitionRow&)>;
using IsOfColumn = std::function<bool(const RecognitionRow&)>;

std::vector<double> figures_of(const Results& results, const std::string& recording,
                               const IsOfColumn& is_of_column, const FigureOf& figure) {
  std::vector<double> values;
  for (const RecognitionRow& row : results.recognition) {
    if (row.recording == recording && is_of_column(row)) values.push_back(figure(row));
  }
  return values;
}

double auc_of(const RecognitionRow& row) { return row.result.auc; }
double full_recall_of(const RecognitionRow& row) { return row.result.recall_at_full_precision; }
double ms_of(const RecognitionRow& row) { return row.ms.at(kTogether).median_ms; }

// A column of a table: its header, which rows it is the mean of, and what the paper has there.
struct Column {
  std::string header;
  IsOfColumn is_of;
};

// Rows of our sequences, those that have no figure left out.
void add_rows(PaperTable& table, const Results& results, const std::vector<Column>& columns,
              const FigureOf& figure, int num_digits) {
  for (const std::string& recording : results.recordings) {
    PaperTable::Row row{{recording}, false};
    bool has_any = false;
    for (const Column& column : columns) {
      const auto values = figures_of(results, recording, column.is_of, figure);
      has_any = has_any || !values.empty();
      row.cells.push_back(mean_cell(values, num_digits));
    }
    if (has_any) table.rows.push_back(row);
  }
}

std::vector<Column> columns_by_draws(const Results& results) {
  std::set<int> draws;
  for (const RecognitionRow& row : results.recognition) {
    if (row.method == kPublishedMethodName && row.search == SearchKind::kSampled)
      draws.insert(row.num_draws);
  }
  const auto of_search = [](SearchKind search, int num_draws) {
    return [search, num_draws](const RecognitionRow& row) {
      return row.method == kPublishedMethodName && row.search == search &&
             row.num_draws == num_draws;
    };
  };
  std::vector<Column> columns;
  for (const int num_draws : draws)
    columns.push_back({std::to_string(num_draws), of_search(SearchKind::kSampled, num_draws)});
  columns.push_back({"all", of_search(SearchKind::kEveryQueue, 0)});
  columns.push_back({"exact", of_search(SearchKind::kExact, 0)});
  return columns;
}

// The published figure for this header, or nothing.
std::string published_by_draws(const std::array<double, 7>& figures, const std::string& header,
                               int num_digits) {
  for (std::size_t i = 0; i < kPublishedNumDraws.size(); ++i) {
    if (header == std::to_string(kPublishedNumDraws[i]))
      return fmt::format("{:.{}f}", figures[i], num_digits);
  }
  return "";
}

// What a table is of.
struct Content {
  int number = 0;
  const char* title = "";
  FigureOf figure;
  int num_digits = 0;
  const std::array<double, 7> PublishedSequence::*published = nullptr;  // none: it has none
  bool is_more_better = false;
};

PaperTable table_by_draws(const Results& results, const Content& content) {
  PaperTable table{.number = content.number,
                   .title = content.title,
                   .header = {"draws L"},
                   .rows = {},
                   .note = {},
                   .is_more_better = content.is_more_better};
  const std::vector<Column> columns = columns_by_draws(results);
  for (const Column& column : columns) table.header.push_back(column.header);
  add_rows(table, results, columns, content.figure, content.num_digits);
  for (const PublishedSequence& sequence : kPublishedSequences) {
    PaperTable::Row row{{fmt::format("published, {}", sequence.name)}, true};
    for (const Column& column : columns)
      row.cells.push_back(
          published_by_draws(sequence.*content.published, column.header, content.num_digits));
    table.rows.push_back(row);
  }
  return table;
}

// Of a descriptor: the published search with the number of draws that it is used with, or the
// exact search. The others have a search of their own.
IsOfColumn is_of_method(const std::string& method, bool is_exact) {
  return [method, is_exact](const RecognitionRow& row) {
    if (row.method != method) return false;
    if (row.search == SearchKind::kOwn) return true;
    if (is_exact) return row.search == SearchKind::kExact;
    return row.search == SearchKind::kSampled && row.num_draws == kPublishedDrawsOfUse;
  };
}

std::vector<Column> columns_by_method(const Results& results, bool is_exact) {
  std::vector<Column> columns;
  for (const ComparedMethod& method : results.methods) {
    const IsOfColumn is_of = is_of_method(method.name, is_exact);
    if (std::any_of(results.recognition.begin(), results.recognition.end(), is_of))
      columns.push_back({method.title, is_of});
  }
  return columns;
}

std::string published_by_method(const Results& results, const std::array<double, 7>& figures,
                                const std::string& header, int num_digits) {
  for (const ComparedMethod& method : results.methods) {
    if (method.title != header) continue;
    for (std::size_t i = 0; i < kPublishedMethods.size(); ++i) {
      if (method.name == kPublishedMethods[i].ours)
        return fmt::format("{:.{}f}", figures[i], num_digits);
    }
  }
  return "";
}

void add_published(PaperTable& table, const Results& results, const Content& content) {
  for (const PublishedSequence& sequence : kPublishedSequences) {
    PaperTable::Row row{{fmt::format("published, {}", sequence.name)}, true};
    for (std::size_t i = 1; i < table.header.size(); ++i) {
      row.cells.push_back(published_by_method(results, sequence.*content.published, table.header[i],
                                              content.num_digits));
    }
    table.rows.push_back(row);
  }
}

PaperTable table_by_method(const Results& results, bool is_exact, const Content& content) {
  PaperTable table{.number = content.number,
                   .title = content.title,
                   .header = {"method"},
                   .rows = {},
                   .note = {},
                   .is_more_better = content.is_more_better};
  const std::vector<Column> columns = columns_by_method(results, is_exact);
  for (const Column& column : columns) table.header.push_back(column.header);
  add_rows(table, results, columns, content.figure, content.num_digits);
  if (content.published != nullptr) add_published(table, results, content);
  return table;
}

std::string loops_cell(const Results& results, const std::string& recording,
                       const IsOfColumn& is_of) {
  const auto right = figures_of(results, recording, is_of,
                                [](const RecognitionRow& row) { return row.loops.num_true; });
  const auto wrong = figures_of(results, recording, is_of,
                                [](const RecognitionRow& row) { return row.loops.num_false; });
  if (right.empty()) return "-";
  return right.size() == 1 ? fmt::format("{:.0f}/{:.0f}", right.front(), wrong.front())
                           : fmt::format("{} / {}", mean_cell(right, 1), mean_cell(wrong, 1));
}

// Of all sequences together, the first seed of each.
std::string all_false_cell(const Results& results, const IsOfColumn& is_of) {
  int num_false = 0;
  int num_classified = 0;
  for (const RecognitionRow& row : results.recognition) {
    if (!is_of(row) || row.seed != 0) continue;
    num_false += row.loops.num_false;
    num_classified += row.loops.num_false + row.loops.num_true;
  }
  return false_share(num_false, num_classified);
}

PaperTable table_of_recognized_loops(const Results& results) {
  PaperTable table{.number = 6,
                   .title = "loops right/wrong, by recognition alone",
                   .header = {"method"},
                   .rows = {},
                   .note =
                       "Accepted at the threshold that each method ships with; loops of near "
                       "places are not counted."};
  const std::vector<Column> columns = columns_by_method(results, false);
  for (const Column& column : columns) table.header.push_back(column.header);
  for (const std::string& recording : results.recordings) {
    PaperTable::Row row{{recording}, false};
    for (const Column& column : columns)
      row.cells.push_back(loops_cell(results, recording, column.is_of));
    table.rows.push_back(row);
  }
  if (table.rows.empty()) return table;
  PaperTable::Row all{{"all, first seed"}, false};
  for (const Column& column : columns) all.cells.push_back(all_false_cell(results, column.is_of));
  table.rows.push_back(all);
  return table;
}

constexpr const char* kDrawsNote =
    "all: every queue once, what more draws tend to. exact: every vector, ranked by NCC and "
    "without "
    "the threshold of the others, so its AUC may be lower.";
constexpr const char* kExactNote =
    "Descriptors alone: every earlier image is compared, and each query is answered; the others as "
    "above.";
constexpr const char* kMethodsNote =
    "Descriptors with the search of the published method, L = 50; the others as they are.";

}  // namespace

std::vector<PaperTable> recognition_tables(const Results& results) {
  std::vector<PaperTable> tables;
  const auto add = [&](PaperTable table, const char* note) {
    table.note = note;
    tables.push_back(std::move(table));
  };
  add(table_by_draws(results, {2, "AUC by number of draws", auc_of, 4,
                               &PublishedSequence::auc_by_draws, true}),
      kDrawsNote);
  add(table_by_draws(results, {3, "milliseconds a frame by number of draws", ms_of, 2,
                               &PublishedSequence::ms_by_draws}),
      "Median on one core, without reading the image; the published ones with a graphics card.");
  add(table_by_method(results, false,
                      {4, "AUC by method", auc_of, 4, &PublishedSequence::auc_by_method, true}),
      kMethodsNote);
  add(table_by_method(results, false,
                      {4, "recall at 100 % precision by method", full_recall_of, 4, nullptr, true}),
      kMethodsNote);
  add(table_by_method(results, true, {4, "AUC by method, exact search", auc_of, 4, nullptr, true}),
      kExactNote);
  add(table_by_method(results, true,
                      {4, "recall at 100 % precision by method, exact search", full_recall_of, 4,
                       nullptr, true}),
      kExactNote);
  add(table_by_method(
          results, false,
          {5, "milliseconds a frame by method", ms_of, 2, &PublishedSequence::ms_by_method}),
      "Median on one core, without reading the image.");
  tables.push_back(table_of_recognized_loops(results));
  return tables;
}

}  // namespace samewhere::paper
