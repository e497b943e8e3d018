#pragma once

#include <functional>
#include <string>
#include <vector>

#include <samewhere/paper/results.hpp>
#include <samewhere/paper/row_store.hpp>
#include <samewhere/paper/runs.hpp>
#include <samewhere/paper/tables.hpp>
#include <samewhere/pipeline/config.hpp>

namespace samewhere::paper {

// What is measured.
struct BenchmarkPlan {
  pipeline::Config config;           // of the published method
  std::vector<std::string> sources;  // SOURCE, SOURCE@149, SOURCE@10s
  // Detectors (methods/methods.hpp) and describers (described_recording.hpp).
  std::vector<std::string> methods;
  // A source, or a method, that cannot be used is an error, else it is a missing row.
  bool needs_all_sources = false;
  bool needs_all_methods = false;
  PaperTableNumbers tables;
  PaperPlan searches;     // of the published method; the other describers have one number of draws
  int num_slam_runs = 3;  // seeds 0, 1, ...
};

// The methods that there are, the published one first, in the order of the tables.
std::vector<std::string> all_methods();

// Throws InputError on a source that is not there, a method that is unknown, two methods or two
// sequences of one name: before any work, and before a folder is made.
void check_plan(const BenchmarkPlan& plan);

// Measures what `store` does not have yet, and keeps it there piece by piece: first recognition,
// then SLAM, one seed of all sequences after the other. `on_news` is told all results after each
// piece. False after Ctrl-C. Throws InputError on a source, method or setting that cannot be used
// and is needed.
bool run_benchmark(const BenchmarkPlan& plan, const RowStore& store, Results& results,
                   const std::function<void(const Results&)>& on_news);

}  // namespace samewhere::paper
