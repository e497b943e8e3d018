#pragma once

#include <optional>

#include <samewhere/core/verdict.hpp>
#include <samewhere/verify/config.hpp>

namespace samewhere::verify {

// Earlier verdicts that count for the next one.
struct History {
  std::optional<core::FrameId> last_loop_query;
};

// The verdict on measured evidence: the checks in the order of core::Refusal, the first that fails
// decides. Pure: the same evidence, history and thresholds give the same verdict, without images.
core::Verdict decide(const core::Candidate& candidate, const core::Evidence& evidence,
                     const History& history, const Config& config);

// The checks before the geometry: similarity and pause.
std::optional<core::Rejection> refuse_early(const core::Candidate& candidate,
                                            const core::Evidence& evidence, const History& history,
                                            const Config& config);

// Whether candidates are confirmed by the views around them: where no relative pose is required.
bool needs_sequences(const Config& config);
// Ambiguous until the views that follow have been seen.
bool is_pending(const core::Verdict& verdict);
// Whether the geometric checks pass.
bool has_geometry(const core::Evidence& evidence, const Config& config);
// The loops of the map, with odometry, place the query elsewhere.
bool contradicts_loops(const core::Evidence& evidence, const Config& config);
// Passes all checks but the last: a loop, or a place that cannot be told from a look-alike.
bool is_recognized(const core::Verdict& verdict);

// What makes a candidate the best of its query: the similarity, or the inliers by the square of the
// overlap, for a view that shows most of the same is wanted, not one that shows a well textured
// corner of it. Of too few inliers, which may agree by chance, no overlap is known: there, and
// among equals, inliers, then similarity decide. The views around do not count: they say that a
// place is seen again, the view itself which part of it.
double rank(const core::Evidence& evidence, const Config& config);

// How sure the evidence is, for precision-recall curves: the similarity, or the inliers, plus the
// similarity mapped into [0, 1), which breaks ties. In a sequence of enough views their mean counts
// and not their sum, for look-alike places give sequences as long, with fewer inliers a view.
// Elsewhere those of the view count, less what a view alone needs more.
double score(const core::Evidence& evidence, const Config& config);

}  // namespace samewhere::verify
