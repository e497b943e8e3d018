#pragma once

#include <optional>
#include <string>
#include <vector>

#include <samewhere/paper/view_pool.hpp>
#include <samewhere/retrieve/config.hpp>

namespace samewhere::paper {

// What the published search misses in a store of one size.
struct BlindSpotPoint {
  int num_stored = 0;
  int num_draws = 0;
  double expected = 0.0;  // evaluate::chance_of_missing of a store with so many queues
  int num_queries = 0;
  double measured = 0.0;  // share of their searches, with 5 seeds each
};

// The share of sampled searches that hand on no view of the right queue, which holds the view that
// the exact search ranks first, for stores of 100, 200, 500, 1000 ... views of the pool. The queue
// was not drawn, or its views are not more similar than config.min_similarity, or
// config.num_candidates others are; the formula counts the first alone. Nothing after Ctrl-C.
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

}  // namespace samewhere::paper
