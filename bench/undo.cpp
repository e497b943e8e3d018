// undo: what is left of a map after a wrong loop was believed and taken back?
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "liar.hpp"
#include "program.hpp"
#include <samewhere/core/progress.hpp>
#include <samewhere/evaluate/trajectory_error.hpp>
#include <samewhere/pipeline/open_source.hpp>
#include <samewhere/pipeline/slam.hpp>

namespace samewhere::bench {
namespace {

struct Settings {
  std::string preset = "hotel";
  int first_seed = 1000;
  int num_seeds = 1;
  int lie_after = 20;  // keyframes
  double doubt = 4.0;
  int num_frames = 0;  // 0: the whole walk
  std::string csv_file;
};

// Odometry that is believed less, so that a lie is believed more; the judge asks as much of a loop,
// in metres, as always.
void doubt_odometry(pipeline::Config& config, double factor) {
  track::DriftConfig& drift = config.track.drift;
  for (double* sigma : {&drift.factor, &drift.per_metre, &drift.per_radian}) *sigma *= factor;
  config.verify.max_odometry_chi_square /= factor * factor;
}

// One walk. `liar` hears each question and sees each version of the map.
double ate_of_walk(const pipeline::Config& config, Liar& liar) {
  const auto source = pipeline::open_source(config);
  liar.begin(source->truth());
  pipeline::SlamHooks hooks;
  hooks.lie = [&](const auto& question, auto& answer) { liar.answer(question, answer); };
  hooks.keep_map = [&](const auto& map, const auto&) { liar.see(map); };
  pipeline::Slam slam(with_window_in_frames(config, source->info()), pipeline::DepthFrom::kSensor,
                      hooks);
  while (const auto frame = source->next()) slam.feed(*frame);
  slam.finish();
  const auto error =
      evaluate::ate(source->truth().trajectory, pipeline::trajectory_of(slam.map(), slam.frames()),
                    evaluate::Alignment::kSe3);
  return error ? error->rmse_m : 0.0;
}

std::vector<std::string> row_of(const std::string& source, const Settings& settings) {
  pipeline::Config config = pipeline::profile("default");
  config.source = source;
  config.threads = false;
  config.twin.num_frames = settings.num_frames;
  doubt_odometry(config, settings.doubt);
  Liar liar(config, settings.lie_after);
  const double after_m = ate_of_walk(config, liar);
  const std::optional<Lie> lie = liar.lie();
  if (!lie) return {source, "no look-alike was found", "", "", "", "", "", "", ""};
  Liar honest(config, *lie);
  const double never_m = ate_of_walk(config, honest);
  const Aftermath& left = liar.aftermath();
  return {source,
          fmt::format("{:.2f}", lie->error_m),
          fmt::format("{} / {}", left.num_merged, left.num_seen),
          left.withdrawn_at ? fmt::format("after {}", *left.withdrawn_at - lie->asked_at) : "no",
          fmt::format("{}", left.num_not_restored),
          fmt::format("{} / {}", left.num_later_merges, left.num_wrong_merges),
          fmt::format("{:.4f}", left.ate_believed_m),
          fmt::format("{:.4f}", after_m),
          fmt::format("{:.4f}", never_m)};
}

void measure(const Settings& settings) {
  Table table{{"walk", "lie off by m", "merged / seen for it", "withdrawn, keyframes",
               "landmarks not as before", "merged since: all / wrong",
               "ATE m of keyframes, believed", "ATE m, withdrawn", "ATE m, never"},
              {}};
  core::Progress progress("walks", settings.num_seeds);
  for (int i = 0; i < settings.num_seeds; ++i) {
    table.rows.push_back(row_of(
        fmt::format("twin:{}?seed={}&similarity=1", settings.preset, settings.first_seed + i),
        settings));
    progress.update(i + 1);
  }
  progress.finish();
  publish(table, settings.csv_file);
}

std::function<void()> set_up(CLI::App& app) {
  const auto settings = std::make_shared<Settings>();
  app.name("undo");
  app.description(
      "A loop between two places that look alike is slipped into a walk; true ones follow.");
  app.add_option("--preset", settings->preset, "of the built-in world");
  app.add_option("--seed", settings->first_seed, "of the first walk");
  app.add_option("--seeds", settings->num_seeds, "walks")->check(CLI::Range(1, 100));
  app.add_option("--after", settings->lie_after, "keyframes before the lie")
      ->check(CLI::Range(1, 100000));
  app.add_option("--doubt", settings->doubt, "factor on what odometry says of its errors")
      ->check(CLI::Range(1.0, 1000.0));
  app.add_option("--frames", settings->num_frames, "of a walk; 0: all")
      ->check(CLI::Range(0, 1000000));
  app.add_option("--csv", settings->csv_file, "write the table to this file, too");
  return [settings] { measure(*settings); };
}

}  // namespace
}  // namespace samewhere::bench

int main(int argc, char** argv) {
  return samewhere::bench::run_program(argc, argv, samewhere::bench::set_up);
}
