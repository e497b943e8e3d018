// undo: what remains in the map after a false loop closure was accepted and withdrawn?
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "program.hpp"
#include "withdrawal_effects.hpp"
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
  int inject_after = 20;  // keyframes
  double doubt = 12.0;
  int num_frames = 0;  // 0: the whole sequence
  bool is_control = false;
  std::string csv_file;
};

// Inflates the covariance of odometry, so that the pose graph accepts a false loop closure. The
// odometry gate of the loop verifier stays as it was, in metres.
void inflate_covariance(pipeline::Config& config, double factor) {
  track::DriftConfig& drift = config.track.drift;
  for (double* sigma : {&drift.factor, &drift.per_metre, &drift.per_radian}) *sigma *= factor;
  config.verify.max_odometry_chi_square /= factor * factor;
}

// Of the frames up to `last_s`, by their poses at the end of the run.
double ate_m(const core::Truth& truth, const pipeline::Slam& slam, double last_s) {
  core::Trajectory trajectory = pipeline::trajectory_of(slam.map(), slam.frames());
  std::erase_if(trajectory, [&](const auto& pose) { return pose.stamp_s > last_s; });
  const auto error = evaluate::ate(truth.trajectory, trajectory, evaluate::Alignment::kSe3);
  return error ? error->rmse_m : 0.0;
}

// Of the run with the false loop closure, and of the reference run without it.
struct Errors {
  double ate_m = 0.0;
  double reference_m = 0.0;
};

// Result of one sequence, with the false loop closure and without it.
struct Outcome {
  std::optional<FalseLoop> false_loop;
  WithdrawalEffects effects;
  // Later odometry differs by chance. None without a false loop.
  std::optional<Errors> until_last_true_loop;
  std::optional<Errors> whole;
  int num_joined_at_end = 0;  // see JoinedClasses
  int num_joined_at_end_reference = 0;
};

// A perturbation that must not matter: moves the first true loop by 1 mm.
void perturb(pipeline::LoopAnswer& answer, bool& is_perturbed) {
  constexpr double kPerturbation_m = 1e-3;
  if (is_perturbed || answer.loops.empty()) return;
  answer.loops[0].edge.match_from_query.translation.x() += kPerturbation_m;
  is_perturbed = true;
}

pipeline::SlamTestHooks reference_hooks(const FalseLoopInjector& injector,
                                        WithdrawalRecorder& recorder) {
  pipeline::SlamTestHooks hooks;
  hooks.alter_loops = [&](const auto& question, auto& answer) {
    injector.answer_with_true_loops(question, answer);
  };
  hooks.keep_map = [&](const auto& map, const auto&) { recorder.receive_reference_map(map); };
  return hooks;
}

// Runs both over the same frames, frame by frame. A control has no false loop closure in either
// run; the first true loop of one is perturbed.
Outcome run_both(const pipeline::Config& config, int inject_after, bool is_control) {
  const auto source = run::open_source(config);
  const core::Truth truth = source->truth();
  FalseLoopInjector injector(config, inject_after, truth);
  WithdrawalRecorder recorder(config, injector, truth);
  const pipeline::Config in_frames = run::with_window_in_frames(config, source->info());
  using pipeline::Slam;
  bool is_perturbed = false;
  pipeline::SlamTestHooks hooks;
  hooks.alter_loops = [&](const auto& question, auto& answer) {
    const pipeline::LoopAnswer of_verifier = answer;
    injector.answer(question, answer);
    if (!is_control) return;
    answer = of_verifier;
    injector.answer_with_true_loops(question, answer);
    perturb(answer, is_perturbed);
  };
  hooks.keep_map = [&](const auto& map, const auto&) { recorder.receive_affected_map(map); };
  Slam affected(in_frames, pipeline::DepthFrom::kSensor, hooks);
  Slam reference(in_frames, pipeline::DepthFrom::kSensor, reference_hooks(injector, recorder));
  while (const auto frame = source->next()) {
    affected.feed(*frame);
    reference.feed(*frame);
  }
  affected.finish();
  reference.finish();
  const auto errors_until = [&](double last_s) {
    return Errors{ate_m(truth, affected, last_s), ate_m(truth, reference, last_s)};
  };
  Outcome outcome{injector.false_loop(), recorder.effects()};
  outcome.whole = errors_until(std::numeric_limits<double>::infinity());
  if (!outcome.false_loop) return outcome;
  const std::size_t last = injector.last_true_loop_at(affected.map());
  outcome.until_last_true_loop = errors_until(affected.map().keyframes[last].view.stamp_s);
  outcome.num_joined_at_end = recorder.joined_in(affected.map()).num_all;
  outcome.num_joined_at_end_reference = recorder.joined_in(reference.map()).num_all;
  return outcome;
}

std::string as_text(const JoinedClasses& joined) {
  return fmt::format("{} / {}", joined.num_all, joined.num_wrong);
}

std::string as_text(const std::optional<FalseLoop>& loop) {
  return loop ? fmt::format("{:.2f}", loop->error_m) : "none was found";
}

// Dashes if no false loop closure was withdrawn.
std::vector<std::string> cells_of(const Outcome& outcome) {
  const WithdrawalEffects& effects = outcome.effects;
  if (!effects.withdrawn_at)
    return {effects.is_accepted ? "yes" : "no",
            effects.is_accepted ? "no" : "-",
            "-",
            "-",
            "-",
            "-",
            "-",
            "-",
            "-"};
  return {"yes",
          fmt::format("after {}", *effects.withdrawn_at - outcome.false_loop->query),
          fmt::format("{} / {}", effects.num_merged, effects.num_observed),
          fmt::format("{:.4f}", effects.ate_accepted_m),
          std::to_string(effects.num_marked),
          std::to_string(effects.num_parted),
          as_text(effects.joined),
          as_text(effects.joined_in_reference),
          fmt::format("{} / {}", outcome.num_joined_at_end, outcome.num_joined_at_end_reference)};
}

std::vector<std::string> row_of(const std::string& source, const Settings& settings) {
  pipeline::Config config = pipeline::profile("default");
  config.source = source;
  config.threads = false;
  config.twin.num_frames = settings.num_frames;
  inflate_covariance(config, settings.doubt);
  const Outcome outcome = run_both(config, settings.inject_after, settings.is_control);
  std::vector<std::string> row = {source, as_text(outcome.false_loop)};
  for (const auto& cell : cells_of(outcome)) row.push_back(cell);
  for (const auto& errors : {outcome.until_last_true_loop, outcome.whole}) {
    row.push_back(errors ? fmt::format("{:.4f} / {:.4f}", errors->ate_m, errors->reference_m)
                         : "-");
    row.push_back(errors ? fmt::format("{:.3f}", errors->ate_m / errors->reference_m) : "-");
  }
  return row;
}

void measure(const Settings& settings) {
  Table table{{"walk", "false loop off by m", "accepted", "withdrawn, keyframes",
               "merged / observed for it", "ATE m of keyframes, accepted", "marks left", "parted",
               "joined: all / wrong", "without it", "joined at the end / without it",
               "ATE m until the last true loop / without it", "ratio",
               "ATE m of the walk / without it", "ratio"},
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
      "Injects a false loop closure between two look-alike places; true loop closures follow.");
  app.add_option("--presets", settings->presets, "of the built-in world");
  app.add_option("--seed", settings->first_seed, "of the first walk of each preset");
  app.add_option("--seeds", settings->num_seeds, "walks of each preset")->check(CLI::Range(1, 100));
  app.add_option("--after", settings->inject_after, "keyframes before the false loop closure")
      ->check(CLI::Range(1, 100000));
  app.add_option("--doubt", settings->doubt, "factor on the standard deviations of odometry")
      ->check(CLI::Range(1.0, 1000.0));
  app.add_option("--frames", settings->num_frames, "of a walk; 0: all")
      ->check(CLI::Range(0, 1000000));
  app.add_flag("--control", settings->is_control,
               "no false loop closure; the first true loop of one run is 1 mm off");
  app.add_option("--csv", settings->csv_file, "write the table to this file, too");
  return [settings] { measure(*settings); };
}

}  // namespace
}  // namespace samewhere::bench

int main(int argc, char** argv) {
  return samewhere::bench::run_program(argc, argv, samewhere::bench::set_up);
}
