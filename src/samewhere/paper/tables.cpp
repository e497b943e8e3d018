#include <algorithm>
#include <array>
#include <functional>
#include <iterator>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/evaluate/statistics.hpp>
#include <samewhere/paper/published.hpp>
#include <samewhere/paper/tables.hpp>
#include <samewhere/report/table.hpp>

namespace samewhere::paper {
namespace {

using Row = std::vector<std::string>;
// The runs of one column of a table: those with one number of draws, which differ by seed.
using Column = std::vector<const PaperRun*>;
// Nothing: the run has no such figure.
using FigureOf = std::function<std::optional<double>(const PaperRun&)>;

std::string column_name(const PaperRun& run) {
  switch (run.search) {
    case retrieve::Search::kExact:
      return "exact";
    case retrieve::Search::kEveryQueue:
      return "all";
    case retrieve::Search::kSampled:
      break;
  }
  return std::to_string(run.num_draws);
}

std::vector<Column> columns_of(const PaperBlock& block) {
  std::vector<Column> columns;
  for (const PaperRun& run : block.runs) {
    if (columns.empty() || column_name(*columns.back().front()) != column_name(run))
      columns.emplace_back();
    columns.back().push_back(&run);
  }
  return columns;
}

Row header_of(const std::vector<Column>& columns, const std::string& first) {
  Row header{first};
  for (const Column& column : columns) header.push_back(column_name(*column.front()));
  return header;
}

std::vector<double> over_seeds(const Column& column, const FigureOf& figure) {
  std::vector<double> values;
  for (const PaperRun* run : column) {
    if (const auto value = figure(*run)) values.push_back(*value);
  }
  return values;
}

// A row of means, and one of standard deviations under it, which a single run has not.
void add_figure(report::Table& table, const std::vector<Column>& columns, const std::string& name,
                const FigureOf& figure, int num_digits = 4) {
  Row means{name};
  Row deviations{"  standard deviation"};
  for (const Column& column : columns) {
    const std::vector<double> values = over_seeds(column, figure);
    const auto [mean, deviation] = evaluate::mean_and_deviation(values);
    means.push_back(values.empty() ? "-" : fmt::format("{:.{}f}", mean, num_digits));
    deviations.push_back(values.size() > 1 ? fmt::format("{:.{}f}", deviation, num_digits) : "");
  }
  table.rows.push_back(means);
  table.rows.push_back(deviations);
}

// A published row below ours: where a column has the same number of draws.
Row published_row(const std::vector<Column>& columns, const std::string& name,
                  const std::array<double, 7>& figures, int num_digits) {
  Row row{name};
  for (const Column& column : columns) {
    const PaperRun& any = *column.front();
    const auto* const known =
        std::find(kPublishedNumDraws.begin(), kPublishedNumDraws.end(), any.num_draws);
    row.push_back(
        any.search != retrieve::Search::kSampled || known == kPublishedNumDraws.end()
            ? ""
            : fmt::format("{:.{}f}",
                          figures[static_cast<std::size_t>(known - kPublishedNumDraws.begin())],
                          num_digits));
  }
  return row;
}

std::string table_2(const std::vector<Column>& columns) {
  report::Table table{header_of(columns, "Table 2: draws L"), {}};
  add_figure(table, columns, "AUC", [](const PaperRun& run) { return run.result.auc; });
  add_figure(table, columns, "recall at 100 % precision",
             [](const PaperRun& run) { return run.result.recall_at_full_precision; });
  add_figure(table, columns, "precision at recall .35",
             [](const PaperRun& run) { return run.result.precision_at_recall_35; });
  add_figure(table, columns, "precision at recall .70",
             [](const PaperRun& run) { return run.result.precision_at_recall_70; });
  for (const PublishedSequence& published : kPublishedSequences) {
    table.rows.push_back(
        published_row(columns, fmt::format("published AUC, {}", published.name), published.auc, 4));
  }
  return report::as_text(table) +
         "all: every queue once, what more draws tend to. exact: every vector, ranked by NCC and "
         "without the threshold of\n"
         "the others, so its AUC may be lower. A recall that a search does not reach counts as "
         "precision 0.\n";
}

// The durations of one step over the frames of all seeds, ms.
using Steps = std::vector<std::pair<std::string, std::vector<double>>>;

Steps steps_of(const PaperBlock& block, const Column& column) {
  std::vector<double> search;
  std::vector<double> exact;
  std::vector<double> together;
  for (const PaperRun* run : column) {
    search.insert(search.end(), run->search_ms.begin(), run->search_ms.end());
    exact.insert(exact.end(), run->exact_similarity_ms.begin(), run->exact_similarity_ms.end());
    for (std::size_t i = 0; i < block.describe_ms.size(); ++i) {
      const auto frame = static_cast<std::size_t>(block.timed_frames.at(i));
      together.push_back(block.describe_ms[i] + run->search_ms.at(frame) +
                         run->exact_similarity_ms.at(frame));
    }
  }
  return {{"preprocess and describe", block.describe_ms},
          {"search", search},
          {"exact similarity", exact},
          {"together", together}};
}

std::string table_3(const PaperBlock& block, const std::vector<Column>& columns) {
  report::Table table{header_of(columns, "Table 3: ms a frame by L"), {}};
  std::vector<Row> rows;
  for (const Column& column : columns) {
    const Steps steps = steps_of(block, column);
    rows.resize(3 * steps.size());
    for (std::size_t i = 0; i < steps.size(); ++i) {
      const core::TimingSummary summary = core::summarize(steps[i].second);
      const std::array<std::pair<std::string, double>, 3> cells = {
          {{steps[i].first + ", median", summary.median_ms},
           {"  p95", summary.p95_ms},
           {"  p99", summary.p99_ms}}};
      for (std::size_t k = 0; k < cells.size(); ++k) {
        Row& row = rows[3 * i + k];
        if (row.empty()) row.push_back(cells[k].first);
        row.push_back(fmt::format("{:.3f}", cells[k].second));
      }
    }
  }
  table.rows = rows;
  for (const PublishedSequence& published : kPublishedSequences) {
    table.rows.push_back(
        published_row(columns, fmt::format("published, {}", published.name), published.ms, 2));
  }
  return report::as_text(table) +
         fmt::format("on one core; description timed on {} frames, apart from reading them\n",
                     block.timed_frames.size());
}

// Nothing where no loop was right or wrong: none is no perfection.
std::optional<double> share_wrong(const PaperRun& run) {
  const int num_judged = run.loops.counts.num_right + run.loops.counts.num_wrong;
  if (num_judged == 0) return std::nullopt;
  return static_cast<double>(run.loops.counts.num_wrong) / num_judged;
}

std::string table_6(const PaperBlock& block, const std::vector<Column>& columns) {
  report::Table table{header_of(columns, "Table 6: loops by L"), {}};
  const auto add = [&](const std::string& name, const FigureOf& figure, int num_digits) {
    add_figure(table, columns, name, figure, num_digits);
  };
  add(
      "right", [](const PaperRun& run) { return run.loops.counts.num_right; }, 1);
  add(
      "wrong", [](const PaperRun& run) { return run.loops.counts.num_wrong; }, 1);
  if (block.runs.front().loops.num_impostors)
    add(
        "  of these impostors",
        [](const PaperRun& run) { return run.loops.num_impostors.value_or(0); }, 1);
  add(
      "near, counted as neither", [](const PaperRun& run) { return run.loops.counts.num_near; }, 1);
  add("wrong / (right + wrong)", share_wrong, 3);
  std::string text = report::as_text(table);
  text +=
      fmt::format("accepted above an NCC of {:g}, with a pause of {} frames{}\n",
                  block.min_similarity, block.pause_frames,
                  block.runs.front().loops.num_impostors ? "" : "; the truth lists no impostors");
  text += "published at L = 50, right/wrong:";
  for (const PublishedSequence& published : kPublishedSequences)
    fmt::format_to(std::back_inserter(text), " {} {}", published.name, published.loops);
  return text + "\n";
}

// A row of searches.csv after the names.
Row search_row(const PaperRun& run) {
  const evaluate::PrecisionRecall& result = run.result;
  const PausedLoops& loops = run.loops;
  return {column_name(run),
          std::to_string(run.seed),
          std::to_string(result.num_queries),
          std::to_string(result.num_with_loop),
          fmt::format("{:.6f}", result.auc),
          fmt::format("{:.6f}", result.recall_at_full_precision),
          fmt::format("{:.6f}", result.precision_at_recall_35),
          fmt::format("{:.6f}", result.precision_at_recall_70),
          std::to_string(loops.counts.num_right),
          std::to_string(loops.counts.num_wrong),
          loops.num_impostors ? std::to_string(*loops.num_impostors) : "",
          std::to_string(loops.counts.num_near)};
}

}  // namespace

PaperTableNumbers parse_table_numbers(const std::string& list) {
  const PaperTableNumbers known{2, 3, 6};
  PaperTableNumbers numbers;
  std::string word;
  for (const char c : list + ",") {
    if (c != ',') {
      word += c;
      continue;
    }
    const auto named = std::find_if(known.begin(), known.end(),
                                    [&](int number) { return word == std::to_string(number); });
    if (named == known.end())
      throw core::InputError(fmt::format(
          "--tables {}: there is no table \"{}\", expected some of 2, 3 and 6", list, word));
    numbers.insert(*named);
    word.clear();
  }
  return numbers;
}

std::string paper_text(const PaperBlock& block, const PaperTableNumbers& numbers) {
  const std::vector<Column> columns = columns_of(block);
  core::require(!columns.empty(), "a block has runs");
  const evaluate::PrecisionRecall& any = block.runs.front().result;
  std::string text = fmt::format("{}, {}: {} frames, {} with a loop, window {} frames, {} seeds\n",
                                 block.recording, block.describer, any.num_queries,
                                 any.num_with_loop, block.window_frames, columns.front().size());
  if (numbers.contains(2)) text += "\n" + table_2(columns);
  if (numbers.contains(3)) text += "\n" + table_3(block, columns);
  if (numbers.contains(6)) text += "\n" + table_6(block, columns);
  return text;
}

std::string searches_csv(const std::vector<PaperBlock>& blocks) {
  report::Table table{
      {"recording", "describer", "describer_checksum", "window_frames", "draws", "seed", "queries",
       "with_loop", "auc", "recall_at_full_precision", "precision_at_recall_35",
       "precision_at_recall_70", "loops_right", "loops_wrong", "loops_impostors", "loops_near"},
      {}};
  for (const PaperBlock& block : blocks) {
    for (const PaperRun& run : block.runs) {
      Row row{block.recording, block.describer, fmt::format("{:016x}", block.describer_checksum),
              std::to_string(block.window_frames)};
      const Row found = search_row(run);
      row.insert(row.end(), found.begin(), found.end());
      table.rows.push_back(row);
    }
  }
  return report::as_csv(table);
}

std::string times_csv(const std::vector<PaperBlock>& blocks) {
  report::Table table{{"recording", "describer", "draws", "step", "median_ms", "p95_ms", "p99_ms"},
                      {}};
  for (const PaperBlock& block : blocks) {
    for (const Column& column : columns_of(block)) {
      for (const auto& [step, durations_ms] : steps_of(block, column)) {
        const core::TimingSummary summary = core::summarize(durations_ms);
        table.rows.push_back({block.recording, block.describer, column_name(*column.front()), step,
                              fmt::format("{:.4f}", summary.median_ms),
                              fmt::format("{:.4f}", summary.p95_ms),
                              fmt::format("{:.4f}", summary.p99_ms)});
      }
    }
  }
  return report::as_csv(table);
}

}  // namespace samewhere::paper
