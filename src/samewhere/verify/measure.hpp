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
};

// How well one geometry explains the two views. With depth in both, the pose is measured from each
// and the answer is their mean, with how far they are apart; inliers and errors are those of the
// match's depth. If the match has depth and the rig is known: the pose of the query among the
// match's points (PnP RANSAC, a second look around the projections, refinement). Otherwise a
// fundamental matrix, and no pose. Views without features give zeros.
core::GeometryEvidence measure_geometry(const core::Candidate& candidate,
                                        const features::View& query, const features::View& match,
                                        const MeasureSettings& settings);

}  // namespace samewhere::verify
