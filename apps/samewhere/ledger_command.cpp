#include <algorithm>
#include <iterator>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "commands.hpp"
#include "ledger_figures.hpp"
#include "options.hpp"
#include "print.hpp"
#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/core/printable.hpp>
#include <samewhere/core/terminal.hpp>
#include <samewhere/report/funnel.hpp>
#include <samewhere/report/loops.hpp>
#include <samewhere/report/pair_figure.hpp>
#include <samewhere/report/table.hpp>
#include <samewhere/run/override.hpp>
#include <samewhere/run/replay.hpp>
#include <samewhere/run/run_folder.hpp>

namespace samewhere::app {
namespace {

struct LedgerCommand {
  std::string folder;
  std::string verdict;
  std::string stage;
  int query = -1;
  std::size_t candidate = 0;
  std::string picture;
  std::vector<std::string> assignments;
};

bool is_wanted(const core::LedgerRow& row, const LedgerCommand& command) {
  const auto query = static_cast<std::uint64_t>(command.query);
  return (command.verdict.empty() || core::name_of(row.verdict) == command.verdict) &&
         (command.stage.empty() || core::stage_of(row.verdict) == command.stage) &&
         (command.query < 0 || row.candidate.query.index() == query);
}

// One line per candidate: frames, verdict and reason. The reason follows the table, left-aligned.
std::string lines_of(const core::Ledger& rows) {
  report::Table table{{"candidate", "query", "match", "verdict", "stage"}, {}};
  for (const core::LedgerRow& row : rows) {
    table.rows.push_back(
        {std::to_string(row.candidate.id.index()), std::to_string(row.candidate.query.index()),
         report::name_of_match(row.candidate), std::string(core::name_of(row.verdict)),
         std::string(core::stage_of(row.verdict))});
  }
  std::istringstream lines(report::as_text(table));
  std::string text;
  std::string line;
  std::getline(lines, line);
  text = line + "  why\n";
  for (const core::LedgerRow& row : rows) {
    std::getline(lines, line);
    text += fmt::format("{}  {}\n", line,
                        core::printable_line(core::reason_of(row.verdict), core::kMaxMessage));
  }
  return text;
}

void list(const LedgerCommand& command) {
  core::Ledger wanted;
  for (const core::LedgerRow& row : run::ledger_of_run(command.folder))
    if (is_wanted(row, command)) wanted.push_back(row);
  core::print("{}", lines_of(wanted));
}

void show(const LedgerCommand& command) {
  const core::Ledger ledger = run::ledger_of_run(command.folder);
  const core::LedgerRow& row = run::row_of(ledger, command.candidate, command.folder);
  print_figures(figures_of(row, run::config_of_run(command.folder).verify));
  if (command.picture.empty()) return;
  core::write_file(command.picture, report::pair_svg(run::pair_of_run(command.folder, row)));
  core::print("{}\n", command.picture);
}

core::Ledger rows_after(const std::vector<run::ReplayedRow>& replayed) {
  core::Ledger ledger;
  for (const auto& row : replayed) ledger.push_back({row.before.candidate, row.after});
  return ledger;
}

void replay(const LedgerCommand& command) {
  if (command.assignments.empty())
    throw core::InputError("replay: expected --set verify.NAME=VALUE or --prior");
  for (const auto& assignment : command.assignments)
    if (!assignment.starts_with("verify."))
      throw core::InputError("--set " + assignment +
                             ": a replay changes thresholds only; expected verify.NAME=VALUE");
  const core::Ledger ledger = run::ledger_of_run(command.folder);
  const verify::Config config = run::config_of_run(command.folder, command.assignments).verify;
  const auto replayed = run::replay(ledger, config);
  core::Ledger changed;
  for (const auto& row : replayed)
    if (row.outcome == run::Replay::kChanged) changed.push_back({row.before.candidate, row.after});
  const auto count = [&](run::Replay outcome) {
    return std::to_string(std::count_if(replayed.begin(), replayed.end(),
                                        [&](const auto& row) { return row.outcome == outcome; }));
  };
  print_figures({{"candidates", std::to_string(replayed.size())},
                 {"unchanged", count(run::Replay::kSame)},
                 {"changed", count(run::Replay::kChanged)},
                 {"unmeasured", count(run::Replay::kUnmeasured)},
                 {"rejected by the pose graph, not replayed", count(run::Replay::kGraph)}});
  core::print("\n{}", report::funnel_text(report::funnel(rows_after(replayed))));
  if (!changed.empty()) core::print("\nChanged:\n{}", lines_of(changed));
}

void change(const LedgerCommand& command, run::Override override_as) {
  constexpr const char* kSections[] = {"optimize.", "map.", "verify."};
  for (const auto& assignment : command.assignments)
    if (std::none_of(std::begin(kSections), std::end(kSections),
                     [&](const char* section) { return assignment.starts_with(section); }))
      throw core::InputError("--set " + assignment +
                             ": expected a setting of optimize, map or verify; the others need the "
                             "images");
  const auto changed =
      run::override_run(command.folder, command.candidate, override_as, command.assignments);
  core::print("{}", lines_of(changed.rows));
  print_figures({{"loop closures",
                  fmt::format("{} (before: {})", changed.num_loops, changed.num_loops_before)},
                 {"largest motion of a keyframe", fmt::format("{:.3f} m", changed.farthest_m)}});
  core::print(
      "Updated: map.sw, loops.json, trajectory.tum, odometry.tum, frames.csv, map.ply.\n"
      "Not updated: report.html and the files of `samewhere dense`.\n");
}

// As core::stage_of() calls them.
std::vector<std::string> names_of_stages() {
  std::vector<std::string> names;
  for (const core::Refusal refusal : core::kAllRefusals) names.emplace_back(name_of(refusal));
  names.emplace_back("accepted");
  return names;
}

void add_list(CLI::App& ledger, const std::shared_ptr<LedgerCommand>& command) {
  CLI::App* sub = ledger.add_subcommand("list", "List the candidates, one per line");
  sub->add_option("--verdict", command->verdict, "only candidates with this verdict")
      ->check(CLI::IsMember({"LOOP", "NOT", "AMBIGUOUS"}));
  sub->add_option("--stage", command->stage, "only candidates decided by this check")
      ->check(CLI::IsMember(names_of_stages()));
  sub->add_option("--query", command->query, "only candidates of this query frame");
  sub->callback([command] { list(*command); });
}

void add_show(CLI::App& ledger, const std::shared_ptr<LedgerCommand>& command) {
  CLI::App* sub = ledger.add_subcommand("show", "Show all measurements of one candidate");
  sub->add_option("N", command->candidate, "its number, as `list` prints it")->required();
  sub->add_option("--picture", command->picture,
                  "SVG file to write: both views with their feature matches");
  sub->callback([command] { show(*command); });
}

void add_replay(CLI::App& ledger, const std::shared_ptr<LedgerCommand>& command) {
  CLI::App* sub = ledger.add_subcommand(
      "replay", "Verify all candidates again with other thresholds, without the images");
  sub->add_option("--set", command->assignments, "verify.NAME=VALUE, as often as needed");
  sub->add_option_function<std::string>(
         "--prior",
         [command](const std::string& prior) {
           command->assignments.push_back("verify.prior=" + prior);
         },
         "the same as --set verify.prior=PRIOR")
      ->type_name("repetitive|unique");
  sub->callback([command] { replay(*command); });
}

void add_change(CLI::App& ledger, const std::shared_ptr<LedgerCommand>& command,
                run::Override override_as, const char* name, const char* help) {
  CLI::App* sub = ledger.add_subcommand(name, help);
  sub->add_option("N", command->candidate, "its number, as `list` prints it")->required();
  sub->add_option("--set", command->assignments, "SECTION.NAME=VALUE, on top of the run's config");
  sub->callback([command, override_as] { change(*command, override_as); });
}

}  // namespace

void add_ledger_command(CLI::App& app) {
  auto command = std::make_shared<LedgerCommand>();
  CLI::App* sub = app.add_subcommand(
      "ledger", "Inspect, replay and override the loop closure decisions of a run");
  sub->add_option("RUN", command->folder,
                  "folder that `samewhere run` or `samewhere loops` wrote, or the map in it")
      ->required()
      ->transform(as_run_folder);
  sub->require_subcommand(1);
  add_list(*sub, command);
  add_show(*sub, command);
  add_replay(*sub, command);
  add_change(*sub, command, run::Override::kReject, "reject",
             "Withdraw an accepted loop with all that it caused, and correct the map");
  add_change(*sub, command, run::Override::kForce, "force",
             "Accept a rejected loop if it is consistent with odometry and the other loops");
  sub->footer(
      "Examples:\n"
      "  samewhere ledger runs/demo list --stage odometry\n"
      "  samewhere ledger runs/demo show 12 --picture why.svg\n"
      "  samewhere ledger runs/demo replay --set verify.min_inliers=80\n"
      "  samewhere ledger runs/demo replay --prior unique\n"
      "  samewhere ledger runs/demo reject 12");
}

}  // namespace samewhere::app
