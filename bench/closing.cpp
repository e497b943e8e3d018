// closing: time from loop decision to corrected map, in maps of several sizes
#include <algorithm>
#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "graph_world.hpp"
#include "program.hpp"
#include <samewhere/core/median.hpp>
#include <samewhere/correct/loop_corrector.hpp>

namespace samewhere::bench {
namespace {

// The first keyframes of a path along the streets of a town, one per metre, with odometry and all
// loops between them.
scene::MapVersion map_of(const GraphWorld& world, std::size_t num_keyframes) {
  scene::MapVersion map;
  for (std::size_t i = 0; i < num_keyframes; ++i) {
    scene::Keyframe keyframe;
    keyframe.id = core::KeyframeId(i);
    keyframe.world_from_body = world.graph.world_from_node[i];
    map.keyframes.push_back(keyframe);
  }
  for (const auto& edge : world.graph.edges) {
    const auto from = static_cast<std::size_t>(edge.a);
    const auto to = static_cast<std::size_t>(edge.b);
    if (std::max(from, to) >= num_keyframes) continue;
    if (edge.is_loop) {
      map.loops.push_back({core::KeyframeId(to), core::KeyframeId(from), edge.a_from_b,
                           edge.information, core::CandidateId(map.loops.size())});
    } else {
      map.keyframes.edit(to).odometry = {core::KeyframeId(from), edge.a_from_b, edge.information};
    }
  }
  return apply(map, correct::solve_poses(map, {}));
}

// A false loop closure: a new one, or a suspended one that is re-tested.
scene::LoopEdge false_loop(const GraphWorld& world, const scene::MapVersion& map) {
  const std::size_t middle = map.keyframes.size() / 2;
  return {core::KeyframeId(middle), core::KeyframeId(middle / 2), core::Rigid3{},
          world.graph.edges.front().information, core::CandidateId(map.loops.size() + 1)};
}

// From the last keyframe to the first.
scene::LoopEdge true_loop(const GraphWorld& world, const scene::MapVersion& map) {
  const std::size_t last = map.keyframes.size() - 1;
  return {core::KeyframeId(last), core::KeyframeId(0),
          inverse(world.world_from_node[0]) * world.world_from_node[last],
          world.graph.edges.front().information, core::CandidateId(map.loops.size())};
}

double closing_ms(const scene::MapVersion& map, const scene::LoopEdge& loop, bool is_true) {
  const auto start = std::chrono::steady_clock::now();
  const correct::Closing closing = correct::close_loop(map, loop, {});
  const scene::MapVersion corrected = apply(map, closing.edit);
  const std::chrono::duration<double, std::milli> spent = std::chrono::steady_clock::now() - start;
  core::require(corrected.loops.size() == map.loops.size() + (is_true ? 1 : 0),
                "only a true loop is accepted");
  return spent.count();
}

// Withdraws an accepted loop: the whole graph is solved without it, from two initializations.
double withdrawing_ms(const scene::MapVersion& map) {
  const auto start = std::chrono::steady_clock::now();
  const scene::Edit edit = correct::withdraw_loop(map, map.loops[map.loops.size() / 2].cause, {});
  const scene::MapVersion without = apply(map, edit);
  const std::chrono::duration<double, std::milli> spent = std::chrono::steady_clock::now() - start;
  core::require(without.loops.size() + 1 == map.loops.size(), "one loop is withdrawn");
  return spent.count();
}

struct Settings {
  std::vector<int> num_keyframes = {100, 500, 1000, 2000};
  int num_runs = 5;
  std::uint64_t seed = 1000;
  std::string csv_file;
};

std::vector<std::string> row_of(const scene::MapVersion& map, const std::string& what,
                                const std::function<double()>& measure_ms, int num_runs) {
  std::vector<double> spent_ms;
  for (int i = 0; i < num_runs; ++i) spent_ms.push_back(measure_ms());
  return {std::to_string(map.keyframes.size()),
          std::to_string(map.loops.size()),
          std::to_string(map.suspended_loops.size()),
          what,
          fmt::format("{:.1f}", *core::median(spent_ms)),
          fmt::format("{:.1f}", *std::max_element(spent_ms.begin(), spent_ms.end()))};
}

void measure(const Settings& settings) {
  Table table{{"keyframes", "loops before", "suspended", "new loop", "ms median", "ms worst"}, {}};
  const GraphWorld world = make_graph(GraphKind::kGrid, {}, settings.seed);
  for (const int num_keyframes : settings.num_keyframes) {
    scene::MapVersion map = map_of(world, static_cast<std::size_t>(num_keyframes));
    const auto add = [&](const std::string& what, const std::function<double()>& measure_ms) {
      table.rows.push_back(row_of(map, what, measure_ms, settings.num_runs));
    };
    const auto close_true_loop = [&] { return closing_ms(map, true_loop(world, map), true); };
    add("true", close_true_loop);
    add("false", [&] { return closing_ms(map, false_loop(world, map), false); });
    add("withdrawal", [&] { return withdrawing_ms(map); });
    map.suspended_loops.push_back(false_loop(world, map));
    add("true", close_true_loop);
  }
  publish(table, settings.csv_file);
}

std::function<void()> set_up(CLI::App& app) {
  const auto settings = std::make_shared<Settings>();
  app.name("closing");
  app.description("Time from loop decision to corrected map.");
  app.add_option("--keyframes", settings->num_keyframes, "sizes of the map")
      ->check(CLI::Range(2, 3500));
  app.add_option("--runs", settings->num_runs, "of each size")->check(CLI::Range(1, 1000));
  app.add_option("--seed", settings->seed, "of the path");
  app.add_option("--csv", settings->csv_file, "write the table to this file, too");
  return [settings] { measure(*settings); };
}

}  // namespace
}  // namespace samewhere::bench

int main(int argc, char** argv) {
  return samewhere::bench::run_program(argc, argv, samewhere::bench::set_up);
}
