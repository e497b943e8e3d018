#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <opencv2/core/mat.hpp>

#include <samewhere/features/features.hpp>
#include <samewhere/features/match_pair.hpp>
#include <samewhere/verify/measure.hpp>

namespace samewhere::verify {

// A view with its picture, 8-bit grey, view.image_size_px.
struct SeenView {
  features::View view;
  cv::Mat grey;
};

// The planes of a registered pair, in their order. Those of features hold a soft dot of height 1
// each.
enum class PairPlane : std::uint8_t {
  kQuery,           // the query's picture, without its light: in [-1, 1], 0 where not both see
  kMatch,           // the match's, brought onto the query's
  kSeenByBoth,      // 1 or 0
  kAgree,           // features that match under one geometry
  kOnlyQueryShows,  // the query's features that should be seen in the match and are not
  kOnlyMatchShows,  // the match's, where they should be in the query
  kAlike,           // how well the pictures correlate around here, at most 3 pixels of a plane
                    // beside where they should, in [0, 1]; 0 where neither shows anything
};
inline constexpr int kNumPairPlanes = 7;
inline constexpr int kPairSide_px = 128;

// Two views laid onto each other: what one shows of a place beside what the other shows of it, so
// that it can be counted what should be seen again and is not.
struct PairView {
  // One plane below the other in the order of PairPlane: kNumPairPlanes * kPairSide_px rows,
  // kPairSide_px columns, 32-bit float. Each is the smallest square of the query's picture that
  // holds all that both see.
  cv::Mat planes;
  double overlap_ratio = 0.0;  // share of the query's picture that the match shows, too
  double scale = 1.0;          // side of a plane's pixel, pixels of the query's picture
  bool is_homography = false;  // false: only a similarity was found

  cv::Mat plane(PairPlane plane) const;
};

// The matches of a candidate that agree on one fundamental matrix (first = feature of the match,
// second = feature of the query), by the settings and the random numbers of measure_geometry();
// empty if there is none. It asks for no depth, so that pairs of any camera look the same.
std::vector<features::Match> agreeing_matches(const core::Candidate& candidate,
                                              const features::View& query,
                                              const features::View& match,
                                              const MeasureSettings& settings);

// Registers the match's picture onto the query's by the homography that most matches agree on or,
// where that folds or shears the picture, by the similarity of least squares. The planes are after
// Doppelgangers (Cai et al., "Doppelgangers: Learning to Disambiguate Images of Similar
// Structures", ICCV 2023), which shows a network both pictures, aligned, and the masks of their
// matches. `matches` are agreeing_matches(). Nothing if they are fewer than 8, or if the pictures
// share less than a tenth of the query's. Throws ContractError if a picture is not 8-bit grey of
// its view's size.
std::optional<PairView> register_pair(const SeenView& query, const SeenView& match,
                                      const std::vector<features::Match>& matches,
                                      const features::Config& config);

}  // namespace samewhere::verify
