#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <samewhere/train/head_network.hpp>
#include <samewhere/train/head_views.hpp>

namespace samewhere::train {

struct HeadEpoch {
  int epoch = 0;  // 0: before the first
  double loss = 0.0;
  double auc = 0.0;  // mean over the walks to validate with
};

// AUC of exact search over the views of a walk (evaluate::precision_recall), ranked by NCC of
// `codes`, one a view; views of the last 10 s are no candidates.
double auc_of_walk(const HeadSource& walk, const std::vector<std::vector<float>>& codes);

// Learns for config.epochs epochs, and keeps the epoch with the best AUC. Each
// source is drawn as often as the others, then an anchor of it; with each comes a view of the same
// place and, in a walk, one of a look-alike place. `on_epoch` may return false to stop.
struct TrainedHead {
  HeadWeights weights;
  HeadEpoch best;
  std::vector<HeadEpoch> history;
};
TrainedHead train_head(HeadKind kind, const std::vector<HeadSource>& sources,
                       const std::vector<HeadSource>& validation, const HeadConfig& config,
                       const std::function<bool(const HeadEpoch&)>& on_epoch);

}  // namespace samewhere::train
