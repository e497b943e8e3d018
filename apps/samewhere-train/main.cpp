// samewhere-train: trains the network that describes a view. `samewhere train` starts it.

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "head.hpp"
#include "options.hpp"
#include <samewhere/core/interrupt.hpp>
#include <samewhere/core/program.hpp>
#include <samewhere/core/progress.hpp>
#include <samewhere/core/terminal.hpp>
#include <samewhere/train/commit.hpp>
#include <samewhere/train/network_file.hpp>

namespace samewhere::train {
namespace {

constexpr const char* kExamples =
    "Examples:\n"
    "  samewhere train --images photos twin:hotel?seed=7 --out models/mine.onnx\n"
    "  samewhere train --images gallery.txt --validate twin:hotel?seed=8 --out mine.onnx\n"
    "  samewhere train --images gallery.txt --out small.onnx --code-size 264 --epochs 20\n"
    "  samewhere train --images photos --out pixels.onnx --target pixels --warp false\n"
    "  samewhere train head --help              heads on the features of published networks\n"
    "An interrupted training resumes when the same command is given again. Written beside\n"
    "FILE.onnx: FILE.json (the card), FILE.checkpoint (until training is complete).";

// What would be found out only after all images are read, or after hours.
void check(const Job& job) {
  plan_network(job.config);  // throws where no layers fit
  require_writable_network(job.out);
}

ImageSet read(const Job& job) {
  std::string current;
  std::optional<core::Progress> progress;
  ImageSet images = read_images(job.images, job.validate, job.config,
                                [&](const std::string& source, int done, int total) {
                                  if (source != current)
                                    progress.emplace("reading " + source, total);
                                  current = source;
                                  progress->update(done);
                                });
  progress.reset();
  for (const SourceCount& source : images.sources) {
    core::print("{}: {} images", source.source, source.num_images);
    if (source.num_unreadable > 0)
      core::print(", {} unreadable ones skipped", source.num_unreadable);
    core::print("\n");
  }
  return images;
}

// False if it was interrupted.
bool run_epoch(Trainer& trainer, int num_epochs) {
  const int epoch = static_cast<int>(trainer.history().size()) + 1;
  const auto start = std::chrono::steady_clock::now();
  core::Progress progress(fmt::format("epoch {}/{}: images", epoch, num_epochs),
                          static_cast<int>(trainer.split().training.size()));
  const auto figures = trainer.run_epoch([&](int done, int) { progress.update(done); });
  progress.finish();
  if (!figures) return false;
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  const bool is_best = trainer.best_epoch().epoch == epoch;
  core::print("epoch {}/{}: loss {:.4f} training, {:.4f} validation{}, {:.1f} images/s\n", epoch,
              num_epochs, figures->training_error, figures->validation_error,
              is_best ? " (best)" : "",
              static_cast<double>(trainer.split().training.size()) / elapsed.count());
  std::fflush(stdout);
  return true;
}

int interrupted(const Trainer& trainer) {
  return core::complain(
      "samewhere",
      fmt::format("interrupted after epoch {}; the same command resumes from there",
                  trainer.history().size()),
      core::kInterruptedExit);
}

int train(const Job& job) {
  check(job);
  const ImageSet images = read(job);
  if (core::is_interrupted()) return core::kInterruptedExit;
  Trainer trainer(job.config, images, checkpoint_of(job.out), kCommit);
  core::print("{} training images, {} validation images\n", trainer.split().training.size(),
              trainer.split().validation.size());
  if (!trainer.history().empty())
    core::print("resuming after epoch {}\n", trainer.history().size());
  if (trainer.commits().size() > 1) {
    spdlog::warn("resumed from another build: trained by the commits {}",
                 fmt::join(trainer.commits(), ", "));
  }
  while (!trainer.is_done()) {
    if (core::is_interrupted() || !run_epoch(trainer, job.config.epochs))
      return interrupted(trainer);
  }
  const Quality quality = write_network(job, images, trainer);
  core::print(
      "{}: epoch {}, validation loss {:.4f}, recognition of warped views {:.1f} % (HOG {:.1f} %)\n",
      job.out.string(), quality.best.epoch, quality.best.validation_error,
      100.0 * quality.recognition, 100.0 * quality.recognition_of_hog);
  return core::kDone;
}

int run(int argc, char** argv) {
  if (argc > 1 && std::string(argv[1]) == "head") return run_head(argc, argv);
  CLI::App app("Train the network that describes a view, and export it to ONNX", "samewhere train");
  Job job{.command = as_typed(argc, argv), .version = SAMEWHERE_VERSION};
  app.add_option("--images", job.images,
                 "recordings, folders of images, lists of images, twin:PRESET?seed=3")
      ->required();
  app.add_option(
      "--validate", job.validate,
      "the same, of other places, for validation; without it blocks of --images are held "
      "out");
  app.add_option("--out", job.out, "FILE.onnx; it must not exist")->required();
  const SettingOptions options(app, job.config);
  app.footer(kExamples);
  if (const std::optional<int> status = parse(app, argc, argv)) return *status;
  options.take();
  core::catch_interrupts();
  use_threads(job.config.threads);
  return train(job);
}

}  // namespace
}  // namespace samewhere::train

int main(int argc, char** argv) {
  using namespace samewhere;
  return core::run_program("samewhere", [&] { return train::run(argc, argv); });
}
