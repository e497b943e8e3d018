#include "pairs_command.hpp"

#include <chrono>
#include <cstdio>
#include <optional>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "options.hpp"
#include <samewhere/core/interrupt.hpp>
#include <samewhere/core/program.hpp>
#include <samewhere/core/progress.hpp>
#include <samewhere/core/terminal.hpp>
#include <samewhere/train/commit.hpp>
#include <samewhere/train/pair_network_file.hpp>

namespace samewhere::train {
namespace {

constexpr const char* kExamples =
    "Examples:\n"
    "  samewhere train pairs 'twin:hotel?seed=7&similarity=0.9' 'twin:second-visit?seed=3' \\\n"
    "    --validate 'twin:hotel?seed=8&similarity=0.9' --out models/mine.onnx\n"
    "A training that was stopped goes on when the same command is given again; --prepared FILE "
    "keeps\n"
    "the pairs, which take longest to make. Beside FILE.onnx: FILE.json (the card).";

// False if it was interrupted.
bool run_epoch(PairTrainer& trainer, int num_epochs) {
  const int epoch = static_cast<int>(trainer.history().size()) + 1;
  const auto start = std::chrono::steady_clock::now();
  core::Progress progress(fmt::format("epoch {}/{}: pairs", epoch, num_epochs),
                          trainer.num_training());
  const auto figures = trainer.run_epoch([&](int done, int) { progress.update(done); });
  progress.finish();
  if (!figures) return false;
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  core::print("epoch {}/{}: loss {:.4f} training, {:.4f} validation{}, {:.1f} pairs/s\n", epoch,
              num_epochs, figures->training_error, figures->validation_error,
              trainer.best_epoch().epoch == epoch ? " (best)" : "",
              trainer.num_training() / elapsed.count());
  std::fflush(stdout);
  return true;
}

PairSet prepare(const PairJob& job) {
  PairSet set = prepared_pairs(job);
  for (const PairSource& source : set.sources) {
    core::print("{}: {} pairs of one place, {} of two that look alike{}\n", source.source,
                source.num_same, source.num_wrong, source.is_held_back ? " (to validate)" : "");
  }
  std::fflush(stdout);
  return set;
}

int train(const PairJob& job) {
  require_writable_network(job.out);
  const PairSet set = prepare(job);
  PairTrainer trainer(job.config, set, checkpoint_of(job.out), kCommit);
  if (!trainer.history().empty())
    core::print("going on after epoch {}\n", trainer.history().size());
  if (trainer.commits().size() > 1) {
    spdlog::warn("begun by another program: trained by the commits {}",
                 fmt::join(trainer.commits(), ", "));
  }
  while (!trainer.is_done()) {
    if (!core::is_interrupted() && run_epoch(trainer, job.config.epochs)) continue;
    return core::complain(
        "samewhere",
        fmt::format("interrupted after epoch {}; the same command goes on from there",
                    trainer.history().size()),
        core::kInterruptedExit);
  }
  const PairQuality quality = write_pair_network(job, set, trainer);
  core::print(
      "{}: epoch {}, validation loss {:.4f}, AUC {:.3f}, {:.1f} % of true pairs kept at 1 % "
      "wrong\n",
      job.out.string(), quality.best.epoch, quality.best.validation_error, quality.separation.auc,
      100.0 * quality.separation.kept_at_1_percent);
  return core::kDone;
}

}  // namespace

int train_pairs(int argc, char** argv) {
  CLI::App app("Train the network that judges whether two views show one place or only look alike",
               "samewhere train pairs");
  PairJob job{.command = as_typed(argc, argv), .version = SAMEWHERE_VERSION};
  app.add_option("SOURCE", job.sources,
                 "twin:PRESET?seed=3&similarity=0.9, recordings with place truth, the folder of IE "
                 "Tower (its gallery)")
      ->required();
  app.add_option("--validate", job.validate, "the same, of other places: which epoch is kept")
      ->required();
  app.add_option("--out", job.out, "FILE.onnx, a name that is free")->required();
  app.add_option("--prepared", job.prepared,
                 "keep the pairs in this file, and take them from there if it is there");
  const SettingOptions options(app, job.config);
  app.footer(kExamples);
  // `pairs` itself is no argument of this command
  if (const std::optional<int> status = parse(app, argc - 1, argv + 1)) return *status;
  options.take();
  core::catch_interrupts();
  use_threads(job.config.threads);
  return train(job);
}

}  // namespace samewhere::train
