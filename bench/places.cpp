// places: once the map is made, does it know which earlier frame shows the same place as each one?
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "program.hpp"
#include "shared_surface.hpp"
#include <samewhere/core/errors.hpp>
#include <samewhere/core/progress.hpp>
#include <samewhere/evaluate/precision_recall.hpp>
#include <samewhere/pipeline/slam.hpp>
#include <samewhere/run/open_source.hpp>

namespace samewhere::bench {
namespace {

struct Options {
  std::vector<std::string> sources;
  int window_frames = 150;
  std::string csv_file;
};

// What the frames with a measured pose show, from where the finished map has them.
struct Seen {
  std::vector<SurfaceView> views;
  std::optional<core::Camera> camera;
};

Seen seen_by_slam(core::Source& source, const pipeline::Config& config) {
  pipeline::Slam slam(run::with_window_in_frames(config, source.info()));
  core::Progress progress(config.source, source.info().num_frames);
  Seen all;
  for (int i = 0; const auto frame = source.next(); ++i) {
    if (!frame->depth_m)
      throw core::InputError(
          fmt::format("{}: frame {} has no depth, expected some", config.source, i));
    all.camera = frame->rig->cameras[0];
    slam.feed(*frame);
    all.views.push_back(surface_view(i, *frame->depth_m, *all.camera));
    progress.update(i + 1);
  }
  slam.finish();
  progress.finish();
  Seen measured{.views = {}, .camera = all.camera};
  for (std::size_t i = 0; i < slam.frames().size(); ++i) {
    const core::FramePose& pose = slam.frames()[i];
    if (!pose.is_measured) continue;
    measured.views.push_back(all.views.at(i));
    measured.views.back().seen.world_from_camera =
        world_from_frame(slam.map(), pose) * slam.map().keyframes[0].view.rig->body_from_camera[0];
  }
  return measured;
}

std::vector<std::string> measure(const std::string& name, int window_frames) {
  pipeline::Config config = pipeline::profile("default");
  config.source = name;
  const auto source = run::open_source_with_truth(config);
  const core::Truth truth = source->truth();
  if (!truth.places)
    throw core::InputError(name + ": the truth says nothing about places, expected a matrix");
  const Seen seen = seen_by_slam(*source, config);
  if (!seen.camera) throw core::InputError(name + ": has no frames, expected some");
  const auto found = evaluate::precision_recall(
      *truth.places, places_by_surface(seen.views, *seen.camera, window_frames), window_frames);
  return {name,
          std::to_string(found.num_queries),
          std::to_string(found.num_with_loop),
          fmt::format("{:.4f}", found.auc),
          fmt::format("{:.4f}", found.recall_at_full_precision),
          std::to_string(found.num_wrong)};
}

std::function<void()> set_up(CLI::App& app) {
  auto options = std::make_shared<Options>();
  app.name("places");
  app.description(
      "With depth and odometry: once the map is made, which earlier frame shows the same place as\n"
      "each one, by where the map has them and by what their depth says that they see? Precision\n"
      "and recall by pr-v2 (docs/evaluation.md).");
  app.add_option("SOURCE", options->sources, "recordings with depth and place truth")->required();
  app.add_option("--window", options->window_frames, "frames no further apart are no loop")
      ->check(CLI::NonNegativeNumber);
  app.add_option("--csv", options->csv_file, "write the table to this file, too");
  return [options] {
    Table table{{"source", "queries", "with a loop", "AUC", "R@100P", "wrong of all answers"}, {}};
    for (const std::string& source : options->sources)
      table.rows.push_back(measure(source, options->window_frames));
    publish(table, options->csv_file);
  };
}

}  // namespace
}  // namespace samewhere::bench

int main(int argc, char** argv) {
  return samewhere::bench::run_program(argc, argv, &samewhere::bench::set_up);
}
