#include <functional>
#include <map>
#include <string>

#include <fmt/format.h>

#include <samewhere/paper/published.hpp>
#include <samewhere/paper/slam_tables.hpp>
#include <samewhere/paper/table_cells.hpp>

namespace samewhere::paper {
namespace {

// The columns of the published tables: its own method, ORB-SLAM2.
constexpr std::array<const char*, 2> kPublishedSystems = {"paper", "usual"};

using SlamFigure = std::function<double(const SlamRow&)>;

std::vector<const SlamRow*> rows_of(const Results& results, const std::string& recording,
                                    const std::string& configuration) {
  std::vector<const SlamRow*> rows;
  for (const SlamRow& row : results.slam) {
    if (row.recording == recording && row.configuration == configuration) rows.push_back(&row);
  }
  return rows;
}

std::string cell(const std::vector<const SlamRow*>& rows, const SlamFigure& figure,
                 int num_digits) {
  std::vector<double> values;
  for (const SlamRow* row : rows) values.push_back(figure(*row));
  return mean_cell(values, num_digits);
}

bool has_rows(const Results& results, const std::string& recording) {
  for (const SlamRow& row : results.slam) {
    if (row.recording == recording) return true;
  }
  return false;
}

std::vector<std::string> header_of(const Results& results, const std::string& first) {
  std::vector<std::string> header{first};
  for (const ComparedMethod& each : results.configurations) header.push_back(each.title);
  return header;
}

// Of our configurations, the published cell below each; empty where the paper has none.
PaperTable::Row published_row(const Results& results, const PublishedSequence& sequence,
                              const std::function<std::string(std::size_t)>& figure) {
  PaperTable::Row row{{fmt::format("published, {}", sequence.name)}, true};
  for (const ComparedMethod& each : results.configurations) {
    std::string text;
    for (std::size_t i = 0; i < kPublishedSystems.size(); ++i) {
      if (each.name == kPublishedSystems[i]) text = figure(i);
    }
    row.cells.push_back(text);
  }
  return row;
}

std::string loops_cell_of(const std::vector<const SlamRow*>& rows) {
  if (rows.empty()) return "-";
  return fmt::format("{} / {}",
                     cell(
                         rows, [](const SlamRow& row) { return row.loops_true; }, 1),
                     cell(
                         rows, [](const SlamRow& row) { return row.loops_false; }, 1));
}

std::string all_loops_cell(const Results& results, const std::string& configuration) {
  int num_false = 0;
  int num_classified = 0;
  for (const SlamRow& row : results.slam) {
    if (row.configuration != configuration || row.seed != 0) continue;
    num_false += row.loops_false;
    num_classified += row.loops_false + row.loops_true;
  }
  return false_share(num_false, num_classified);
}

PaperTable table_of_loops(const Results& results) {
  PaperTable table{.number = 6,
                   .title = "loops right/wrong in SLAM",
                   .header = header_of(results, "loop closing"),
                   .rows = {},
                   .note =
                       "A loop is wrong if its relative pose is off by more than 0.2 m or 6 "
                       "degrees, or if it has none and joins different places."};
  for (const std::string& recording : results.recordings) {
    if (!has_rows(results, recording)) continue;
    PaperTable::Row row{{recording}, false};
    for (const ComparedMethod& each : results.configurations)
      row.cells.push_back(loops_cell_of(rows_of(results, recording, each.name)));
    table.rows.push_back(row);
  }
  if (table.rows.empty()) return table;
  PaperTable::Row all{{"all, first seed"}, false};
  for (const ComparedMethod& each : results.configurations)
    all.cells.push_back(all_loops_cell(results, each.name));
  table.rows.push_back(all);
  for (const PublishedSequence& sequence : kPublishedSequences) {
    table.rows.push_back(
        published_row(results, sequence, [&](std::size_t i) { return sequence.loops[i]; }));
  }
  return table;
}

PaperTable::Row error_row(const std::string& name, const std::vector<const SlamRow*>& rows) {
  PaperTable::Row row{{name}, false};
  std::vector<const SlamRow*> scored;
  for (const SlamRow* each : rows) {
    if (each->ate_m) scored.push_back(each);
  }
  for (const auto member : {&SlamError::max, &SlamError::min, &SlamError::median, &SlamError::rmse})
    row.cells.push_back(cell(
        scored, [&](const SlamRow& each) { return (*each.ate_m).*member; }, 4));
  row.cells.push_back(cell(
      rows, [](const SlamRow& each) { return 100.0 * each.num_measured / each.num_frames; }, 1));
  return row;
}

PaperTable table_of_errors(const Results& results) {
  PaperTable table{
      .number = 7,
      .title = "absolute trajectory error, m",
      .header = {"sequence, loop closing", "max", "min", "median", "RMSE", "frames with a pose, %"},
      .rows = {},
      .note =
          "Over all frames with a measured pose, aligned by SE3, or by Sim3 where "
          "one camera without depth leaves the scale open."};
  for (const std::string& recording : results.recordings) {
    for (const ComparedMethod& each : results.configurations) {
      const auto rows = rows_of(results, recording, each.name);
      if (!rows.empty())
        table.rows.push_back(error_row(fmt::format("{}, {}", recording, each.title), rows));
    }
  }
  for (const PublishedSequence& sequence : kPublishedSequences) {
    for (std::size_t i = 0; i < sequence.error_m.size(); ++i) {
      const PublishedError& error = sequence.error_m[i];
      table.rows.push_back(
          {{fmt::format("published, {}, {}", sequence.name, i == 0 ? "its method" : "ORB-SLAM2"),
            fmt::format("{:.4f}", error.max), fmt::format("{:.4f}", error.min),
            fmt::format("{:.4f}", error.median), fmt::format("{:.4f}", error.rmse), ""},
           true});
    }
  }
  return table;
}

PaperTable table_of_rates(const Results& results) {
  PaperTable table{.number = 8,
                   .title = "frames per second",
                   .header = header_of(results, "loop closing"),
                   .rows = {},
                   .note = "Of the whole of SLAM, without reading the images."};
  for (const std::string& recording : results.recordings) {
    if (!has_rows(results, recording)) continue;
    PaperTable::Row row{{recording}, false};
    for (const ComparedMethod& each : results.configurations) {
      row.cells.push_back(cell(
          rows_of(results, recording, each.name),
          [](const SlamRow& run) { return run.frames_per_second; }, 1));
    }
    table.rows.push_back(row);
  }
  for (const PublishedSequence& sequence : kPublishedSequences) {
    table.rows.push_back(published_row(results, sequence, [&](std::size_t i) {
      return fmt::format("{:.2f}", sequence.frames_per_second[i]);
    }));
  }
  return table;
}

}  // namespace

std::vector<PaperTable> slam_tables(const Results& results) {
  return {table_of_loops(results), table_of_errors(results), table_of_rates(results)};
}

}  // namespace samewhere::paper
