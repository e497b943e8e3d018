// rendering SPEC...: how fast do pictures of a twin building come, and what is on them?
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>

#include "program.hpp"
#include <samewhere/core/grey.hpp>
#include <samewhere/core/timing.hpp>
#include <samewhere/twin/front/twin.hpp>

namespace samewhere::bench {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

struct Options {
  std::vector<std::string> specs;
  int num_frames = 120;
  int num_workers = 2;
  std::string csv_file;
};

std::vector<std::string> measure(const std::string& spec, const Options& options) {
  constexpr int kFastThreshold = 20;
  const twin::Config config{.num_frames = options.num_frames, .num_workers = options.num_workers};
  const Clock::time_point start = Clock::now();
  const auto source = twin::open_twin(spec, config);
  std::optional<core::Frame> frame = source->next();
  const double first_s = seconds_since(start);
  const Clock::time_point second = Clock::now();
  int num_frames = 0;
  double num_corners = 0.0;
  while ((frame = source->next())) {
    ++num_frames;
    if (num_frames % 10 != 0) continue;  // looking takes its time, too
    const cv::Mat grey = core::as_grey(frame->images.front());
    std::vector<cv::KeyPoint> corners;
    cv::FAST(grey, corners, kFastThreshold);
    num_corners += static_cast<double>(corners.size());
  }
  const double rest_s = seconds_since(second);
  return {spec,
          std::to_string(options.num_workers),
          fmt::format("{:.2f}", first_s),
          fmt::format("{:.1f}", num_frames / rest_s),
          fmt::format("{:.0f}", 1000.0 * rest_s * options.num_workers / num_frames),
          fmt::format("{:.0f}", core::peak_memory_mib()),
          fmt::format("{:.0f}", num_corners / (num_frames / 10))};
}

std::function<void()> set_up(CLI::App& app) {
  auto options = std::make_shared<Options>();
  app.name("rendering");
  app.description(
      "How fast pictures of a twin building come (640 x 480, with depth or a second camera, as "
      "the\n"
      "spec says), and how many FAST corners (threshold 20) they show. SAMEWHERE_CACHE is to be "
      "unset.");
  app.add_option("SPEC", options->specs, "twin:PRESET?seed=1000")->required();
  app.add_option("--frames", options->num_frames, "so many from the start of the walk")
      ->check(CLI::Range(20, 100000))
      ->capture_default_str();
  app.add_option("--workers", options->num_workers, "threads that render")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  app.add_option("--csv", options->csv_file, "write the table to this file, too");
  return [options] {
    Table table{{"walk", "threads", "s to the first frame", "frames per second", "ms of one thread",
                 "peak MiB so far", "corners"},
                {}};
    for (const auto& spec : options->specs) table.rows.push_back(measure(spec, *options));
    publish(table, options->csv_file);
  };
}

}  // namespace
}  // namespace samewhere::bench

int main(int argc, char** argv) {
  return samewhere::bench::run_program(argc, argv, samewhere::bench::set_up);
}
