#pragma once

#include <cstdint>

#include <samewhere/core/verdict.hpp>
#include <samewhere/features/config.hpp>
#include <samewhere/features/features.hpp>
#include <samewhere/optimize/config.hpp>
#include <samewhere/verify/config.hpp>

namespace samewhere::verify {

struct MeasureSettings {
  Config verify;
  features::Config features;
  optimize::Config optimize;
  std::uint64_t seed = 0;
  bool has_one_scale = true;  // depths of both views are lengths of one scale
};

// How well one geometry explains the two views. With depth in both, the pose is measured from each
// and the answer is their mean, with how far they are apart; inliers and errors are those of the
// match's depth. If the match has depth and the rig is known: the pose of the query among the
// match's points (PnP RANSAC, a second search near the projections, refinement). Otherwise a
// fundamental matrix, and no pose. In recognition alone a fundamental matrix even with depth, and
// the pose if it passes the checks. Views without features give zeros. Views of different scale are
// measured in lengths of the match, and with how long is there what is 1 long at the query: the
// median over the inliers of the depth that the pose gives a point in the query, by the depth that
// the query gives it.
core::GeometryEvidence measure_geometry(const core::Candidate& candidate,
                                        const features::View& query, const features::View& match,
                                        const MeasureSettings& settings);

}  // namespace samewhere::verify
