// search SOURCE...: what does finding a view among many stored ones cost, step by step?
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "program.hpp"
#include <samewhere/core/errors.hpp>
#include <samewhere/core/interrupt.hpp>
#include <samewhere/core/random.hpp>
#include <samewhere/core/similarity.hpp>
#include <samewhere/core/timing.hpp>
#include <samewhere/describe/describer.hpp>
#include <samewhere/paper/view_pool.hpp>
#include <samewhere/retrieve/retriever.hpp>
#include <samewhere/retrieve/search.hpp>
#include <samewhere/run/open_source.hpp>

namespace samewhere::bench {
namespace {

struct Options {
  std::vector<std::string> sources;
  std::vector<int> sizes{1000, 100'000};
  int num_queries = 200;
  pipeline::Config config = pipeline::profile("default");
  std::vector<std::string> assignments;
  std::string csv_file;
};

paper::ViewPool pool_of(const Options& options, describe::Describer& describer) {
  std::vector<pipeline::Config> configs;
  for (const std::string& name : options.sources) {
    configs.push_back(options.config);
    configs.back().source = run::absolute_source(name);
  }
  auto pool = paper::make_view_pool(
      configs, describer, {.num_stored = options.sizes.back(), .num_queries = options.num_queries});
  if (!pool) throw core::Interrupted();
  return std::move(*pool);
}

// The time of one reading of what exact search reads: no search can be faster.
float sum_of_all(const retrieve::SegmentedStore& store) {
  constexpr std::size_t kNumLanes = 32;
  std::vector<float> sums(kNumLanes);
  for (int i = 0; i < store.num_vectors(); ++i) {
    const std::span<const float> vector = store.vector(i);
    for (std::size_t k = 0; k + kNumLanes <= vector.size(); k += kNumLanes) {
      for (std::size_t lane = 0; lane < kNumLanes; ++lane) sums[lane] += vector[k + lane];
    }
  }
  return *std::max_element(sums.begin(), sums.end());
}

// A store of real views that grows from size to size, and what each step of a query costs in it.
class SearchBench {
 public:
  explicit SearchBench(const Options& options)
      : options_(options),
        describer_(describe::make_describer(options.config.describe)),
        pool_(pool_of(options, *describer_)),
        store_(options.config.retrieve.group_size, options.config.retrieve.queue_size) {}

  void measure(int num_views, Table& table) {
    core::Timings timings;
    while (store_.num_vectors() < num_views) store_next(timings);
    int num_found = 0;
    for (std::size_t i = 0; i < pool_.queries.size(); ++i) num_found += query(i, timings) ? 1 : 0;
    const double found = static_cast<double>(num_found) / static_cast<double>(pool_.queries.size());
    for (const auto& [step, durations_ms] : timings.durations_ms()) {
      const core::TimingSummary summary = core::summarize(durations_ms);
      table.rows.push_back(
          {fmt::format("{} of {}", step, num_views), fmt::format("{:.4f}", summary.median_ms),
           fmt::format("{:.4f}", summary.p95_ms), fmt::format("{:.4f}", summary.p99_ms),
           step == "search, sampled" ? fmt::format("{:.2f}", found) : "",
           fmt::format("{:.0f}", core::peak_memory_mib())});
    }
  }

 private:
  void store_next(core::Timings& timings) {
    const auto& view = pool_.stored[static_cast<std::size_t>(store_.num_vectors())];
    const core::ScopedTimer timer(timings, "store");
    store_.append(view.frame, view.unit);
  }

  // Whether the sampled search has found the most similar view.
  bool query(std::size_t number, core::Timings& timings) {
    const core::Descriptor& query = pool_.queries[number];
    {
      const core::ScopedTimer timer(timings, "describe");
      describer_->describe(query.frame, pool_.pictures[number]);
    }
    const auto exact = exact_search(query, timings);
    const auto sampled = sampled_search(query, number, timings);
    compare(query, exact, timings);
    {
      const core::ScopedTimer timer(timings, "reading once");
      core::require(std::isfinite(sum_of_all(store_)), "descriptors are numbers");
    }
    return std::any_of(sampled.begin(), sampled.end(),
                       [&](const auto& found) { return found.position == exact.front().position; });
  }

  std::vector<retrieve::ScoredPosition> exact_search(const core::Descriptor& query,
                                                     core::Timings& timings) const {
    const core::ScopedTimer timer(timings, "search, exact");
    return best(
        retrieve::exact_search(store_, {core::centred_unit(query.unit), store_.num_vectors()}));
  }

  std::vector<retrieve::ScoredPosition> sampled_search(const core::Descriptor& query,
                                                       std::size_t number,
                                                       core::Timings& timings) const {
    core::Random random(core::seed_of(static_cast<std::uint64_t>(store_.num_vectors()), "search",
                                      static_cast<std::uint64_t>(number)));
    const core::ScopedTimer timer(timings, "search, sampled");
    return best(retrieve::sampled_search(store_, {query.unit, store_.num_vectors()},
                                         options_.config.retrieve, random));
  }

  std::vector<retrieve::ScoredPosition> best(std::vector<retrieve::ScoredPosition> scored) const {
    return retrieve::best_places(store_, std::move(scored), options_.config.retrieve);
  }

  void compare(const core::Descriptor& query, const std::vector<retrieve::ScoredPosition>& found,
               core::Timings& timings) const {
    const core::ScopedTimer timer(timings, "exact similarity");
    std::vector<retrieve::FoundView> views;
    for (const auto& scored : found) {
      const std::span<const float> vector = store_.vector(scored.position);
      views.push_back({store_.frame(scored.position), {vector.begin(), vector.end()}});
    }
    core::require(retrieve::compare(query, views).size() == found.size(), "each has a similarity");
  }

  const Options& options_;
  std::unique_ptr<describe::Describer> describer_;
  paper::ViewPool pool_;
  retrieve::SegmentedStore store_;
};

void measure(Options& options) {
  for (const auto& assignment : options.assignments) core::set_config(options.config, assignment);
  std::sort(options.sizes.begin(), options.sizes.end());
  Table table{{"step", "median ms", "p95", "p99", "best one found", "peak MiB so far"}, {}};
  SearchBench bench(options);
  for (const int size : options.sizes) bench.measure(size, table);
  publish(table, options.csv_file);
}

std::function<void()> set_up(CLI::App& app) {
  const auto options = std::make_shared<Options>();
  app.name("search");
  app.description(
      "What finding a view among many costs, by step, on one core. The stored views are the "
      "sources'\n"
      "images and, when these are used up, random crops of them; the queries are other crops, "
      "spread "
      "evenly. Describing\n"
      "is timed on the whole images that the queries are crops of, when all are read.");
  app.add_option("SOURCE", options->sources, "recordings and twin: buildings")->required();
  app.add_option("--sizes", options->sizes, "of the store, views")
      ->check(CLI::Range(1, 10'000'000))
      ->capture_default_str();
  app.add_option("--queries", options->num_queries, "in a store of each size")
      ->check(CLI::Range(1, 1'000'000))
      ->capture_default_str();
  app.add_option("--set", options->assignments, "one setting, e.g. retrieve.num_draws=70")
      ->allow_extra_args(false);
  app.add_option("--csv", options->csv_file, "write the table to this file, too");
  return [options] { measure(*options); };
}

}  // namespace
}  // namespace samewhere::bench

int main(int argc, char** argv) {
  return samewhere::bench::run_program(argc, argv, samewhere::bench::set_up);
}
