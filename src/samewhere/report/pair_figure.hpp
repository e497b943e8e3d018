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
  cv::Size image_size_px;  // of the original image
};

// A candidate with its two views and their matches.
struct PairRecord {
  core::LedgerRow row;
  PairView query;
  PairView match;
  // Positions of matched features in the image of the query and in that of the match.
  std::vector<std::pair<Eigen::Vector2f, Eigen::Vector2f>> matches_px;
};

// A stand-alone SVG file: both views side by side, the query on the left, lines between matched
// features, and below them verdict, scores and reason.
std::string pair_svg(const PairRecord& record);

}  // namespace samewhere::report
