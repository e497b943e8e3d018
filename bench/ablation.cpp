// ablation: which loops would be accepted without one check of the loop verifier? Replays the
// ledgers of finished runs.
#include <algorithm>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "program.hpp"
#include <samewhere/core/errors.hpp>
#include <samewhere/core/progress.hpp>
#include <samewhere/evaluate/loop_check.hpp>
#include <samewhere/run/open_source.hpp>
#include <samewhere/run/replay.hpp>
#include <samewhere/run/run_folder.hpp>
#include <samewhere/run/run_metrics.hpp>

namespace samewhere::bench {
namespace {

struct Variant {
  std::string name;
  std::vector<std::string> assignments;  // that disable the check
};

std::vector<Variant> variants() {
  const std::string no_odometry = "verify.max_odometry_chi_square=1e9";
  const std::string no_competing_loop = "verify.max_competing_chi_square=1e9";
  const std::string no_competing_place = "verify.max_competing_place_ratio=1e9";
  return {{"nothing", {}},
          {"inliers: 7 are enough", {"verify.min_inliers=7", "verify.min_matches=7"}},
          {"spread", {"verify.min_spread_ratio=0"}},
          {"depths agree, where both views have some",
           {"verify.max_pose_difference_m=100", "verify.max_pose_difference_rad=3.2"}},
          {"odometry gate", {no_odometry}},
          {"competing hypothesis: the last loop", {no_competing_loop}},
          {"competing hypothesis: another place for the same view", {no_competing_place}},
          {"odometry gate and the last loop", {no_odometry, no_competing_loop}},
          {"odometry gate and both competing hypotheses",
           {no_odometry, no_competing_loop, no_competing_place}},
          {"all but inliers",
           {no_odometry, no_competing_loop, no_competing_place, "verify.min_spread_ratio=0",
            "verify.max_pose_difference_m=100", "verify.max_pose_difference_rad=3.2"}}};
}

struct Counts {
  int num_true = 0;
  int num_false = 0;
  int num_first = 0;  // of the false ones: the place is not in the map, so no hypothesis competes
  int num_unknown = 0;
  int num_revisits = 0;
  int num_closed = 0;
};

struct Recorded {
  std::string folder;
  core::Truth truth;
  core::Ledger ledger;
  double window_s = 0.0;
};

Recorded recorded(const std::string& folder) {
  const pipeline::Config config = run::config_of_run(folder);
  const auto source = run::open_source(config);
  Recorded run{folder, source->truth(), run::ledger_of_run(folder), config.retrieve.window_s};
  if (!run.truth.places || run.truth.trajectory.empty())
    throw core::InputError(folder + ": its source has no truth of places and poses, expected one");
  return run;
}

// On an earlier visit: before the window in which views are no candidates for each other.
bool was_seen_before(const core::Truth& truth, int query, double window_s) {
  const auto stamp_s = [&](int i) { return truth.trajectory[static_cast<std::size_t>(i)].stamp_s; };
  for (int earlier = 0; earlier < query && stamp_s(earlier) < stamp_s(query) - window_s;
       ++earlier) {
    if (truth.places->at(query, earlier) != core::PlaceTruth::kDifferent) return true;
  }
  return false;
}

void add(const core::Ledger& ledger, const core::Truth& truth, double window_s, Counts& counts) {
  run::StampOf stamp_of;
  for (std::size_t i = 0; i < truth.trajectory.size(); ++i)
    stamp_of[core::FrameId(i)] = truth.trajectory[i].stamp_s;
  run::SlamFindings findings;
  run::add_loops(ledger, stamp_of, findings);
  const evaluate::LoopCheck check = evaluate::check_loops(findings.loops, truth);
  counts.num_true += check.num_true;
  counts.num_false += check.num_false;
  counts.num_unknown += check.num_unknown;
  counts.num_revisits += check.num_revisits;
  counts.num_closed += check.num_closed;
  for (const evaluate::CheckedLoop& checked : check.loops) {
    const bool is_false = checked.truth == evaluate::LoopTruth::kFalse;
    if (is_false && !was_seen_before(truth, checked.loop.query, window_s)) ++counts.num_first;
  }
}

core::Ledger replayed(const Recorded& run, const std::vector<std::string>& assignments) {
  const verify::Config config = run::config_of_run(run.folder, assignments).verify;
  core::Ledger ledger;
  for (const auto& row : run::replay(run.ledger, config))
    ledger.push_back({row.before.candidate, row.after});
  return ledger;
}

std::vector<std::string> row_of(const std::string& name, const Counts& counts) {
  return {name,
          std::to_string(counts.num_true),
          std::to_string(counts.num_false),
          std::to_string(counts.num_first),
          std::to_string(counts.num_unknown),
          fmt::format("{} of {}", counts.num_closed, counts.num_revisits)};
}

void measure(const std::vector<std::string>& folders, const std::string& csv_file) {
  const std::vector<Variant> all = variants();
  Counts as_it_was;
  std::vector<Counts> counts(all.size());
  core::Progress progress("runs", static_cast<int>(folders.size()));
  int num_done = 0;
  for (const std::string& folder : folders) {
    const Recorded run = recorded(folder);
    add(run.ledger, run.truth, run.window_s, as_it_was);
    for (std::size_t i = 0; i < all.size(); ++i)
      add(replayed(run, all[i].assignments), run.truth, run.window_s, counts[i]);
    progress.update(++num_done);
  }
  progress.finish();
  Table table{
      {"left out", "true", "false", "of these first look-alikes", "unknown", "revisits closed"},
      {}};
  table.rows.push_back(row_of("(the run itself)", as_it_was));
  for (std::size_t i = 0; i < all.size(); ++i) table.rows.push_back(row_of(all[i].name, counts[i]));
  publish(table, csv_file);
}

std::function<void()> set_up(CLI::App& app) {
  const auto folders = std::make_shared<std::vector<std::string>>();
  const auto csv_file = std::make_shared<std::string>();
  app.name("ablation");
  app.description(
      "Loops that the loop verifier would accept in finished runs with depth without one of its "
      "checks, by replay. What was not measured behind a check passes; consistency with other "
      "loops is not replayed. First look-alike: no earlier visit has seen the place.");
  app.add_option("RUN", *folders, "folders that `samewhere run` wrote, of sources with truth")
      ->required();
  app.add_option("--csv", *csv_file, "write the table to this file, too");
  return [folders, csv_file] { measure(*folders, *csv_file); };
}

}  // namespace
}  // namespace samewhere::bench

int main(int argc, char** argv) {
  return samewhere::bench::run_program(argc, argv, samewhere::bench::set_up);
}
