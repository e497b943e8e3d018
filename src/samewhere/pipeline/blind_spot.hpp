#pragma once

#include <optional>
#include <string>
#include <vector>

#include <samewhere/core/descriptor.hpp>
#include <samewhere/describe/describer.hpp>
#include <samewhere/pipeline/config.hpp>
#include <samewhere/retrieve/config.hpp>

namespace samewhere::pipeline {

// Views for stores of any size up to a largest one, and views to ask for.
struct ViewPool {
  std::vector<core::Descriptor> stored;
  std::vector<core::Descriptor> queries;
};

// All frames of the sources in turn, then random crops of them in the same order until there are
// `num_stored`; the queries are other crops of frames spread evenly over the sources. Reads each
// source once, with a progress line on stderr. Nothing after Ctrl-C. Throws InputError.
std::optional<ViewPool> make_view_pool(const std::vector<Config>& sources,
                                       describe::Describer& describer, int num_stored);

// What the published search misses in a store of one size.
struct BlindSpotPoint {
  int num_stored = 0;
  int num_draws = 0;
  double expected = 0.0;  // evaluate::chance_of_missing of a store with so many queues
  int num_queries = 0;    // that the store holds something like
  double measured = 0.0;  // share of their searches, with 5 seeds each
};

// The share of sampled searches that find nothing in the queue which holds the view that the exact
// search ranks first, for stores of 100, 200, 500, 1000 ... views of the pool. Only queries count
// whose cosine with that view exceeds config.min_similarity: the others are missed however often
// the queue is drawn. Nothing after Ctrl-C. Throws InputError if a store has none for any.
std::optional<std::vector<BlindSpotPoint>> measure_blind_spot(const ViewPool& pool,
                                                              const retrieve::Config& config,
                                                              const std::vector<int>& num_draws);

// One sentence on the largest store with the number of draws that profile `paper` has.
std::string blind_spot_sentence(const std::vector<BlindSpotPoint>& points, int num_draws);
// Lines as the formula has them, up to 100,000 views, and marks as measured. `config` has the
// queues.
std::string blind_spot_svg(const std::vector<BlindSpotPoint>& points,
                           const retrieve::Config& config);
std::string blind_spot_csv(const std::vector<BlindSpotPoint>& points);

}  // namespace samewhere::pipeline
