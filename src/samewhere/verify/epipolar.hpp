#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include <samewhere/core/random.hpp>
#include <samewhere/core/verdict.hpp>
#include <samewhere/features/features.hpp>
#include <samewhere/features/match_pair.hpp>
#include <samewhere/geometry/two_view.hpp>
#include <samewhere/verify/measure.hpp>

namespace samewhere::verify {

// The random numbers of a candidate: seeded by the pair, not by a counter, so that judging it again
// gives the same evidence.
core::Random random_of(const core::Candidate& candidate, const MeasureSettings& settings);

// Their undistorted pixels, first = of the match.
geometry::PixelPairs pixels_of(const features::View& query, const features::View& match,
                               const std::vector<features::Match>& matches);

// The matches that agree on one fundamental matrix.
struct EpipolarInliers {
  Eigen::Matrix3d fundamental = Eigen::Matrix3d::Zero();  // query' F match = 0, undistorted pixels
  std::vector<features::Match> matches;  // first = feature of the match, second = of the query
  geometry::PixelPairs pairs;            // their undistorted pixels, first = of the match
};

// Of `matches` by looks. Nothing if no matrix explains enough of them.
std::optional<EpipolarInliers> epipolar_inliers(const features::View& query,
                                                const features::View& match,
                                                const std::vector<features::Match>& matches,
                                                const Config& config, core::Random& random);

}  // namespace samewhere::verify
