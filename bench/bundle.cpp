// bundle: how long does a local bundle take, and does it find the poses?
#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "program.hpp"
#include <samewhere/core/timing.hpp>
#include <samewhere/optimize/bundle.hpp>
#include <samewhere/optimize/test_scene.hpp>

namespace samewhere::bench {
namespace {

constexpr int kRepeats = 9;

double worst_error_m(const optimize::BundleProblem& truth, const optimize::BundleResult& result) {
  double worst = 0.0;
  for (std::size_t i = 0; i < truth.cameras.size(); ++i) {
    worst = std::max(worst, core::log_r3so3(inverse(truth.cameras[i].camera_from_world) *
                                            result.camera_from_world[i])
                                .head<3>()
                                .norm());
  }
  return worst;
}

std::vector<std::string> row(const std::string& name, const optimize::SceneSettings& settings) {
  core::Random random(1);
  const optimize::BundleProblem truth = test_scene(settings, random);
  const optimize::BundleProblem start = disturbed(truth, 0.01, 0.03, random);
  core::Timings timings;
  optimize::BundleResult result;
  for (int i = 0; i < kRepeats; ++i) {
    const core::ScopedTimer timer(timings, name);
    result = solve_bundle(start, {});
  }
  std::vector<double> ms = timings.durations_ms().at(name);
  std::sort(ms.begin(), ms.end());
  return {name,
          std::to_string(settings.num_cameras),
          std::to_string(truth.observations.size()),
          fmt::format("{:.1f}", ms[ms.size() / 2]),
          std::to_string(result.num_iterations),
          fmt::format("{:.1f}", 1e3 * worst_error_m(truth, result))};
}

void measure(const std::string& csv_file) {
  Table table{{"bundle", "keyframes", "observations", "median ms", "iterations", "worst pose mm"},
              {}};
  table.rows.push_back(row("with depth", {.num_cameras = 20, .num_points = 900}));
  table.rows.push_back(row(
      "pixels alone", {.num_cameras = 20, .num_points = 900, .num_fixed = 2, .has_depth = false}));
  publish(table, csv_file);
}

std::function<void()> set_up(CLI::App& app) {
  const auto csv_file = std::make_shared<std::string>();
  app.name("bundle");
  app.description("Time and result of bundles of made-up scenes, on one core.");
  app.add_option("--csv", *csv_file, "write the table to this file, too");
  return [csv_file] { measure(*csv_file); };
}

}  // namespace
}  // namespace samewhere::bench

int main(int argc, char** argv) {
  return samewhere::bench::run_program(argc, argv, samewhere::bench::set_up);
}
