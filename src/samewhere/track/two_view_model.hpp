#pragma once

#include <string>
#include <vector>

#include <samewhere/core/random.hpp>
#include <samewhere/core/result.hpp>
#include <samewhere/core/rigid3.hpp>
#include <samewhere/features/features.hpp>
#include <samewhere/features/match_pair.hpp>
#include <samewhere/geometry/ray_pairs.hpp>
#include <samewhere/track/config.hpp>

namespace samewhere::track {

// Why two views do not start a map, in the order of the checks.
enum class StartRefusal { kFewMatches, kDegenerate, kLowParallax, kAmbiguous, kFewPoints };

struct NoStart {
  StartRefusal refusal = StartRefusal::kFewMatches;
  int num_matches = 0;
  std::string reason;  // one sentence with the figure and the threshold
};

// Two calibrated views and which of their features show the same points. Refers to all three.
struct MatchedViews {
  const features::View& first;
  const features::View& second;
  const std::vector<features::Match>& matches;
};

// The rays of the matches, in their order.
geometry::RayPairs ray_pairs(const MatchedViews& views);

// Motions of which one is the true one, and the pairs that agree with the model behind them.
struct TwoViewModel {
  std::vector<core::Rigid3> motions;  // second_from_first, translations of length 1
  std::vector<int> inliers;           // indices of pairs, ascending
  bool is_planar = false;             // a homography
};

// What relates two views, by config.model, each model by RANSAC over the matches (`pairs` are their
// rays):
//
// kHomographyOrEssential: homography and essential matrix are both estimated and scored by their
//   symmetric transfer errors; of S_H / (S_H + S_E) above config.min_homography_ratio the scene is
//   flat or hardly moved against, and the motions are those of the homography, none if it is that
//   of a rotation (Mur-Artal, Montiel and Tardos, "ORB-SLAM", T-RO 2015, section IV).
// kFundamental: F from the pixels, then E = K' F K and its four motions, eq. (18)-(22). Points of a
//   plane, and views that only turned, fit infinitely many F: above the same ratio these are
//   refused (kDegenerate), since a motion of one such F would be invented.
//
// Refused as well (kFewMatches): fewer than config.min_points agree with any model.
Result<TwoViewModel, NoStart> estimate_model(const MatchedViews& views,
                                             const geometry::RayPairs& pairs,
                                             const InitializationConfig& config,
                                             core::Random& random);

}  // namespace samewhere::track
