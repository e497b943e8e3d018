#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "commands.hpp"
#include "options.hpp"
#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/core/terminal.hpp>
#include <samewhere/report/compare.hpp>
#include <samewhere/run/export_place.hpp>

namespace samewhere::app {
namespace {

namespace fs = std::filesystem;

constexpr core::SizeLimit kReportLimit{200'000'000, "a report of up to 200 MB"};
// A longer value would push the columns apart; the page has all of them.
constexpr std::size_t kLongestValue = 34;

struct CompareCommand {
  std::vector<std::string> runs;
  std::vector<std::string> names;
  std::string out = "compare.html";
  bool is_forced = false;
};

// The last part of each path, or where two are equal the paths.
std::vector<std::string> names_of(const std::vector<std::string>& runs) {
  std::vector<std::string> names;
  for (const std::string& run : runs)
    names.push_back(fs::absolute(run + "/").lexically_normal().parent_path().filename().string());
  std::vector<std::string> sorted = names;
  std::sort(sorted.begin(), sorted.end());
  const bool are_unique = std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end();
  return are_unique ? names : runs;
}

report::Table shown_metrics(const std::vector<report::ComparedRun>& runs) {
  report::Table table = report::metrics_of(runs);
  std::erase_if(table.rows, [](const std::vector<std::string>& row) {
    return std::any_of(row.begin() + 1, row.end(),
                       [](const std::string& cell) { return cell.size() > kLongestValue; });
  });
  return table;
}

std::string sentence_of(const report::JudgedElsewhere& judged,
                        const std::vector<report::ComparedRun>& runs) {
  int total = 0;
  std::vector<std::string> parts;
  for (const auto& [verdict, count] : judged.verdicts) {
    total += count;
    parts.push_back(fmt::format("{} {}", count, verdict));
  }
  return fmt::format("The {} false loop{} of {}, as {} judged the same views: {}", total,
                     total == 1 ? "" : "s", runs[judged.accepted_by].name,
                     runs[judged.judged_by].name, fmt::join(parts, "; "));
}

void execute(const CompareCommand& command) {
  if (!command.names.empty() && command.names.size() != command.runs.size()) {
    throw core::InputError(fmt::format("--names: {} names for {} runs; expected one for each",
                                       command.names.size(), command.runs.size()));
  }
  run::check_export_file(command.out, "", command.is_forced);
  const std::vector<std::string> names =
      command.names.empty() ? names_of(command.runs) : command.names;
  std::vector<report::ComparedRun> runs;
  for (std::size_t i = 0; i < command.runs.size(); ++i) {
    const fs::path page = fs::path(as_run_folder(command.runs[i])) / "report.html";
    runs.push_back(
        report::read_report_html(core::read_file(page, kReportLimit), names[i], page.string()));
  }
  core::print("{}\n", report::as_text(shown_metrics(runs)));
  for (const report::JudgedElsewhere& judged : report::judged_elsewhere(runs))
    core::print("{}\n", sentence_of(judged, runs));
  core::write_file(command.out, report::compare_html(runs));
  core::print("{}\n", command.out);
}

}  // namespace

void add_compare_command(CLI::App& app) {
  auto command = std::make_shared<CompareCommand>();
  CLI::App* sub = app.add_subcommand(
      "compare", "Finished runs side by side: one page with their maps, loops and metrics");
  sub->add_option("RUN", command->runs, "folders that `samewhere run` wrote")
      ->required()
      ->expected(2, 8);
  sub->add_option("--names", command->names, "their names on the page; default: of the folders")
      ->delimiter(',');
  sub->add_option("--out", command->out, "HTML file to write")->capture_default_str();
  sub->add_flag("--force", command->is_forced, "replace the file");
  sub->footer(
      "Examples:\n"
      "  samewhere compare runs/monday runs/tuesday --out week.html\n"
      "  samewhere compare runs/a runs/b --names before,after");
  sub->callback([command] { execute(*command); });
}

}  // namespace samewhere::app
