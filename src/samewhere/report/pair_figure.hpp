#pragma once

#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core/types.hpp>

#include <samewhere/core/ledger.hpp>

namespace samewhere::report {

// One view of a candidate.
struct PairView {
  std::string jpeg;        // of any size
  cv::Size image_size_px;  // of the picture that it was made of
};

// A candidate and what was seen.
struct PairRecord {
  core::LedgerRow row;
  PairView query;
  PairView match;
  // Features that match, where they are in the picture of the query and in that of the match.
  std::vector<std::pair<Eigen::Vector2f, Eigen::Vector2f>> matches_px;
};

// An SVG file of its own: both views side by side, the query on the left, lines between what
// matches, and below them verdict, scores and reason.
std::string pair_svg(const PairRecord& record);

}  // namespace samewhere::report
