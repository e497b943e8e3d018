// undo: what is left of a map after a wrong loop was believed and taken back?
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "aftermath.hpp"
#include "program.hpp"
#include <samewhere/core/progress.hpp>
#include <samewhere/evaluate/trajectory_error.hpp>
#include <samewhere/pipeline/slam.hpp>
#include <samewhere/pipeline/slam_test_hooks.hpp>
#include <samewhere/run/open_source.hpp>

namespace samewhere::bench {
namespace {

struct Settings {
  std::vector<std::string> presets = {"hotel"};
  int first_seed = 1000;
  int num_seeds = 1;
  int lie_after = 20;  // keyframes
  double doubt = 12.0;
  int num_frames = 0;  // 0: the whole walk
  bool is_control = false;
  std::string csv_file;
};

// Odometry that is believed less, so that a lie is believed more; the judge asks as much of a loop,
// in metres, as always.
void doubt_odometry(pipeline::Config& config, double factor) {
  track::DriftConfig& drift = config.track.drift;
  for (double* sigma : {&drift.factor, &drift.per_metre, &drift.per_radian}) *sigma *= factor;
  config.verify.max_odometry_chi_square /= factor * factor;
}

// Of the frames up to that one, as all of the walk has placed them.
double ate_m(const core::Truth& truth, const pipeline::Slam& slam, double last_s) {
  core::Trajectory trajectory = pipeline::trajectory_of(slam.map(), slam.frames());
  std::erase_if(trajectory, [&](const auto& pose) { return pose.stamp_s > last_s; });
  const auto error = evaluate::ate(truth.trajectory, trajectory, evaluate::Alignment::kSe3);
  return error ? error->rmse_m : 0.0;
}

// Of who was lied to and of who never was.
struct Errors {
  double ate_m = 0.0;
  double never_m = 0.0;
};

// What came of one walk, for who was lied to and for who never was.
struct Outcome {
  std::optional<Lie> lie;
  Aftermath aftermath;
  std::optional<Errors> until_last_truth;  // later odometry is chance; none without a lie
  std::optional<Errors> whole;
  int num_joined_at_end = 0;  // see Joined
  int num_joined_at_end_never = 0;
};

// What ought to change nothing: the first true loop, a millimetre off.
void nudge(pipeline::LoopAnswer& answer, bool& is_nudged) {
  constexpr double kNudge_m = 1e-3;
  if (is_nudged || answer.loops.empty()) return;
  answer.loops[0].edge.match_from_query.translation.x() += kNudge_m;
  is_nudged = true;
}

pipeline::SlamTestHooks never_lied_to(const Liar& liar, Witness& witness) {
  pipeline::SlamTestHooks hooks;
  hooks.alter_loops = [&](const auto& question, auto& answer) {
    liar.answer_honestly(question, answer);
  };
  hooks.keep_map = [&](const auto& map, const auto&) { witness.see_honest(map); };
  return hooks;
}

// Both walk side by side: each sees a frame when the other does. In a control nobody is lied to,
// and the first is nudged.
Outcome walk_twice(const pipeline::Config& config, int lie_after, bool is_control) {
  const auto source = run::open_source(config);
  const core::Truth truth = source->truth();
  Liar liar(config, lie_after, truth);
  Witness witness(config, liar, truth);
  const pipeline::Config in_frames = run::with_window_in_frames(config, source->info());
  using pipeline::Slam;
  bool is_nudged = false;
  pipeline::SlamTestHooks lied_to;
  lied_to.alter_loops = [&](const auto& question, auto& answer) {
    const pipeline::LoopAnswer of_judge = answer;
    liar.answer(question, answer);
    if (!is_control) return;
    answer = of_judge;
    liar.answer_honestly(question, answer);
    nudge(answer, is_nudged);
  };
  lied_to.keep_map = [&](const auto& map, const auto&) { witness.see_believer(map); };
  Slam believer(in_frames, pipeline::DepthFrom::kSensor, lied_to);
  Slam honest(in_frames, pipeline::DepthFrom::kSensor, never_lied_to(liar, witness));
  while (const auto frame = source->next()) {
    believer.feed(*frame);
    honest.feed(*frame);
  }
  believer.finish();
  honest.finish();
  const auto errors_until = [&](double last_s) {
    return Errors{ate_m(truth, believer, last_s), ate_m(truth, honest, last_s)};
  };
  Outcome outcome{liar.lie(), witness.aftermath()};
  outcome.whole = errors_until(std::numeric_limits<double>::infinity());
  if (!outcome.lie) return outcome;
  const std::size_t last = liar.last_truth_at(believer.map());
  outcome.until_last_truth = errors_until(believer.map().keyframes[last].view.stamp_s);
  outcome.num_joined_at_end = witness.joined_in(believer.map()).num_all;
  outcome.num_joined_at_end_never = witness.joined_in(honest.map()).num_all;
  return outcome;
}

std::string as_text(const Joined& joined) {
  return fmt::format("{} / {}", joined.num_all, joined.num_wrong);
}

std::string as_text(const std::optional<Lie>& lie) {
  return lie ? fmt::format("{:.2f}", lie->error_m) : "none was found";
}

// Dashes where no lie was withdrawn, and so nothing is left of one.
std::vector<std::string> cells_of(const Outcome& outcome) {
  const Aftermath& left = outcome.aftermath;
  if (!left.withdrawn_at)
    return {left.is_believed ? "yes" : "no",
            left.is_believed ? "no" : "-",
            "-",
            "-",
            "-",
            "-",
            "-",
            "-",
            "-"};
  return {"yes",
          fmt::format("after {}", *left.withdrawn_at - outcome.lie->asked_at),
          fmt::format("{} / {}", left.num_merged, left.num_seen),
          fmt::format("{:.4f}", left.ate_believed_m),
          std::to_string(left.num_marked),
          std::to_string(left.num_parted),
          as_text(left.joined),
          as_text(left.joined_meanwhile),
          fmt::format("{} / {}", outcome.num_joined_at_end, outcome.num_joined_at_end_never)};
}

std::vector<std::string> row_of(const std::string& source, const Settings& settings) {
  pipeline::Config config = pipeline::profile("default");
  config.source = source;
  config.threads = false;
  config.twin.num_frames = settings.num_frames;
  doubt_odometry(config, settings.doubt);
  const Outcome outcome = walk_twice(config, settings.lie_after, settings.is_control);
  std::vector<std::string> row = {source, as_text(outcome.lie)};
  for (const auto& cell : cells_of(outcome)) row.push_back(cell);
  for (const auto& errors : {outcome.until_last_truth, outcome.whole}) {
    row.push_back(errors ? fmt::format("{:.4f} / {:.4f}", errors->ate_m, errors->never_m) : "-");
    row.push_back(errors ? fmt::format("{:.3f}", errors->ate_m / errors->never_m) : "-");
  }
  return row;
}

void measure(const Settings& settings) {
  Table table{{"walk", "lie off by m", "believed", "withdrawn, keyframes", "merged / seen for it",
               "ATE m of keyframes, believed", "marks left", "parted", "joined: all / wrong",
               "never lied to", "joined at the end / never lied to",
               "ATE m until the last true loop / never lied to", "ratio",
               "ATE m of the walk / never lied to", "ratio"},
              {}};
  core::Progress progress("walks", settings.num_seeds * static_cast<int>(settings.presets.size()));
  for (const auto& preset : settings.presets) {
    for (int i = 0; i < settings.num_seeds; ++i) {
      table.rows.push_back(row_of(
          fmt::format("twin:{}?seed={}&similarity=1", preset, settings.first_seed + i), settings));
      progress.update(static_cast<int>(table.rows.size()));
    }
  }
  progress.finish();
  publish(table, settings.csv_file);
}

std::function<void()> set_up(CLI::App& app) {
  const auto settings = std::make_shared<Settings>();
  app.name("undo");
  app.description(
      "A loop between two places that look alike is slipped into a walk; true ones follow.");
  app.add_option("--presets", settings->presets, "of the built-in world");
  app.add_option("--seed", settings->first_seed, "of the first walk in each");
  app.add_option("--seeds", settings->num_seeds, "walks in each")->check(CLI::Range(1, 100));
  app.add_option("--after", settings->lie_after, "keyframes before the lie")
      ->check(CLI::Range(1, 100000));
  app.add_option("--doubt", settings->doubt, "factor on what odometry says of its errors")
      ->check(CLI::Range(1.0, 1000.0));
  app.add_option("--frames", settings->num_frames, "of a walk; 0: all")
      ->check(CLI::Range(0, 1000000));
  app.add_flag("--control", settings->is_control,
               "nobody is lied to; one hears the first true loop a millimetre off");
  app.add_option("--csv", settings->csv_file, "write the table to this file, too");
  return [settings] { measure(*settings); };
}

}  // namespace
}  // namespace samewhere::bench

int main(int argc, char** argv) {
  return samewhere::bench::run_program(argc, argv, samewhere::bench::set_up);
}
