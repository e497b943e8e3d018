#include "head.hpp"

#include <cstdio>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "options.hpp"
#include <samewhere/core/errors.hpp>
#include <samewhere/core/interrupt.hpp>
#include <samewhere/core/program.hpp>
#include <samewhere/core/progress.hpp>
#include <samewhere/core/terminal.hpp>
#include <samewhere/train/commit.hpp>
#include <samewhere/train/head_file.hpp>
#include <samewhere/train/held_back.hpp>
#include <samewhere/twin/building/spec.hpp>

namespace samewhere::train {
namespace {

constexpr const char* kHeadExamples =
    "Examples:\n"
    "  samewhere train head gem --images photos 'twin:hotel?seed=7' --validate "
    "'twin:office-loop?seed=21' --out mine.onnx\n"
    "then: samewhere bench paper SOURCE --tables 4 --methods hog,mine.onnx";

std::vector<HeadSource> read_sources(const HeadJob& job, const std::vector<std::string>& names,
                                     network::Trunk& trunk) {
  std::vector<HeadSource> sources;
  for (const std::string& name : names) {
    std::optional<core::Progress> progress;
    sources.push_back(
        read_head_source(name, trunk, job.config, job.cache, [&](int done, int total) {
          if (!progress) progress.emplace("reading " + name, total);
          progress->update(done);
        }));
    progress.reset();
    core::print("{}: {} views\n", name, sources.back().num_views());
    std::fflush(stdout);
  }
  return sources;
}

void check(const HeadJob& job) {
  require_other_places(job.images, job.validate, "--images");
  for (const std::string& name : job.validate) {
    if (!twin::is_twin_spec(name)) {
      throw core::InputError(
          fmt::format("--validate {}: expected twin:PRESET, whose places are known", name));
    }
  }
  require_writable_network(job.out);
}

int train(const HeadJob& job) {
  check(job);
  const network::TrunkSpec spec = trunk_of(job.kind);
  const auto trunk = network::make_trunk(network::find_trunk(job.trunks, spec.file), spec);
  const std::vector<HeadSource> sources = read_sources(job, job.images, *trunk);
  const std::vector<HeadSource> validation = read_sources(job, job.validate, *trunk);
  const TrainedHead trained =
      train_head(job.kind, sources, validation, job.config, [&](const HeadEpoch& epoch) {
        core::print("epoch {}/{}: loss {:.4f}, AUC {:.4f}\n", epoch.epoch, job.config.epochs,
                    epoch.loss, epoch.auc);
        std::fflush(stdout);
        return !core::is_interrupted();
      });
  core::stop_if_interrupted();
  write_head(job, trained, sources, validation, *trunk);
  core::print("{}: epoch {}, AUC {:.4f}\n", job.out.string(), trained.best.epoch, trained.best.auc);
  return core::kDone;
}

}  // namespace

int run_head(int argc, char** argv) {
  CLI::App app("Train a head on the features of a published network, and export it to ONNX",
               "samewhere train head");
  HeadJob job{.command = as_typed(argc, argv), .version = SAMEWHERE_VERSION, .commit = kCommit};
  const std::map<std::string, HeadKind> kinds{
      {"gem", HeadKind::kGem}, {"netvlad", HeadKind::kNetvlad}, {"darknet", HeadKind::kDarknet}};
  app.add_option("KIND", job.kind,
                 "gem: generalized mean, netvlad: NetVLAD (both of MobileNetV2), darknet: mean of "
                 "four parts (of a Darknet detector)")
      ->required()
      ->transform(CLI::CheckedTransformer(kinds));
  app.add_option("--images", job.images, "folders of images, lists of images, twin:PRESET?seed=3")
      ->required();
  app.add_option("--validate", job.validate, "twin:PRESET?seed=4, to select the epoch by AUC");
  app.add_option("--out", job.out, "FILE.onnx; it must not exist")->required();
  app.add_option("--cache", job.cache, "folder to keep the features in");
  app.add_option("--trunks", job.trunks, "folder of the published networks");
  const SettingOptions options(app, job.config);
  app.footer(kHeadExamples);
  if (const std::optional<int> status = parse(app, argc - 1, argv + 1)) return *status;
  options.take();
  core::catch_interrupts();
  use_threads(job.config.threads);
  return train(job);
}

}  // namespace samewhere::train
