// bundle: how long does the robust round of a local bundle take, by our solver and by Ceres, and
// does it find the poses?
#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "program.hpp"
#include <samewhere/core/timing.hpp>
#include <samewhere/optimize/schur.hpp>
#include <samewhere/optimize/test_scene.hpp>

namespace samewhere::bench {
namespace {

constexpr int kRepeats = 9;

using Minimise = int (*)(optimize::BundleState&, bool is_robust, int max_iterations);

optimize::BundleState state_of(const optimize::BundleProblem& problem) {
  optimize::BundleState state{&problem, {}, problem.points_in_world, {}};
  for (const auto& camera : problem.cameras)
    state.camera_from_world.push_back(camera.camera_from_world);
  state.is_used.assign(problem.observations.size(), true);
  return state;
}

double worst_error_m(const optimize::BundleProblem& truth, const optimize::BundleState& state) {
  double worst = 0.0;
  for (std::size_t i = 0; i < truth.cameras.size(); ++i) {
    worst = std::max(worst, core::log_r3so3(inverse(truth.cameras[i].camera_from_world) *
                                            state.camera_from_world[i])
                                .head<3>()
                                .norm());
  }
  return worst;
}

std::vector<std::string> row(const std::string& name, Minimise minimise,
                             const optimize::SceneSettings& settings) {
  core::Random random(1);
  const optimize::BundleProblem truth = test_scene(settings, random);
  const optimize::BundleProblem start = disturbed(truth, 0.01, 0.03, random);
  core::Timings timings;
  optimize::BundleState state;
  int num_iterations = 0;
  for (int i = 0; i < kRepeats; ++i) {
    state = state_of(start);
    const core::ScopedTimer timer(timings, name);
    num_iterations = minimise(state, true, optimize::Config{}.bundle_iterations);
  }
  std::vector<double> ms = timings.durations_ms().at(name);
  std::sort(ms.begin(), ms.end());
  return {name,
          std::to_string(settings.num_cameras),
          std::to_string(truth.observations.size()),
          fmt::format("{:.1f}", ms[ms.size() / 2]),
          std::to_string(num_iterations),
          fmt::format("{:.1f}", 1e3 * worst_error_m(truth, state))};
}

void measure(const std::string& csv_file) {
  Table table{{"bundle", "keyframes", "observations", "median ms", "iterations", "worst pose mm"},
              {}};
  const optimize::SceneSettings with_depth{.num_cameras = 20, .num_points = 900, .num_fixed = 2};
  optimize::SceneSettings pixels_alone = with_depth;
  pixels_alone.has_depth = false;
  table.rows.push_back(row("with depth, ours", optimize::minimise_by_schur, with_depth));
  table.rows.push_back(row("with depth, Ceres", optimize::minimise_by_ceres, with_depth));
  table.rows.push_back(row("pixels alone, ours", optimize::minimise_by_schur, pixels_alone));
  table.rows.push_back(row("pixels alone, Ceres", optimize::minimise_by_ceres, pixels_alone));
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
