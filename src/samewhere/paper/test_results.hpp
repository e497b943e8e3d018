#pragma once

#include <string>

#include <samewhere/paper/results.hpp>

namespace samewhere::paper {

// Made-up results, for tests only: two seeds of a search with 50 draws, a detector, two runs of
// SLAM.
inline RecognitionRow made_up_row(const std::string& method, SearchKind search, int seed,
                                  double auc) {
  RecognitionRow row{
      .recording = "hall <1>",
      .window_frames = 7,
      .method = method,
      .search = search,
      .num_draws = search == SearchKind::kSampled ? 50 : 0,
      .seed = seed,
      .result = {.curve = {{0.5, 1.0, 0.9}, {1.0, 0.75, 0.4}},
                 .auc = auc,
                 .recall_at_full_precision = 0.5,
                 .precision_at_recall_35 = 1.0,
                 .precision_at_recall_70 = 0.75,
                 .num_queries = 20,
                 .num_with_loop = 8,
                 .max_recall = 1.0,
                 .num_false = 2},
      .loops = {.num_true = 6, .num_false = 0, .num_near = 1},
      .ms = {
          {kTogether,
           {.count = 20, .median_ms = 12.5, .p95_ms = 15.0, .p99_ms = 20.0, .total_ms = 250.0}}}};
  if (method == "paper")
    row.loops = {.num_true = 4, .num_false = 1, .num_near = 0, .num_aliased = 1};
  return row;
}

inline SlamRow made_up_slam(const std::string& configuration, int seed, double rmse_m) {
  return {.recording = "hall <1>",
          .configuration = configuration,
          .seed = seed,
          .num_frames = 20,
          .num_measured = 19,
          .ate_m = SlamError{2.0 * rmse_m, 0.01, 0.9 * rmse_m, rmse_m},
          .loops_true = 3,
          .loops_false = configuration == "usual" ? 2 : 0,
          .frames_per_second = 40.0,
          .path = {{{0.0, 0.0, 0.0}, {0.1, 0.0, 0.0}}, {{1.0, 0.0, 2.0}, {1.1, 0.0, 2.0}}},
          .loops = {{{1.1, 0.0, 2.0}, {0.1, 0.0, 0.0}, configuration == "usual"}}};
}

inline Results made_up_results() {
  return {.recordings = {"hall <1>"},
          .methods = {{"paper", "published method", "its search"}, {"ours", "samewhere", "ours"}},
          .configurations = {{"usual", "bag of words", "words"}, {"default", "samewhere", "ours"}},
          .recognition = {made_up_row("paper", SearchKind::kSampled, 0, 0.7),
                          made_up_row("paper", SearchKind::kSampled, 1, 0.8),
                          made_up_row("paper", SearchKind::kExact, 0, 0.85),
                          made_up_row("ours", SearchKind::kOwn, 0, 0.95)},
          .slam = {made_up_slam("usual", 0, 2.0), made_up_slam("default", 0, 0.1),
                   made_up_slam("usual", 1, 4.0), made_up_slam("default", 1, 0.1)},
          .missing = {{"", "gem", "no file"}}};
}

}  // namespace samewhere::paper
