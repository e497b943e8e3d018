#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include <samewhere/core/descriptor.hpp>
#include <samewhere/core/ledger.hpp>
#include <samewhere/features/features.hpp>
#include <samewhere/verify/measure.hpp>
#include <samewhere/verify/numbered_views.hpp>
#include <samewhere/verify/pending_candidates.hpp>

namespace samewhere::verify {

// Sequence verification, for recognition alone: a candidate is pending
// until consecutive views match, too, and the continuation of a sequence is predicted. Does nothing
// where needs_sequences() is false. After Milford and Wyeth, SeqSLAM, ICRA 2012
// (docs/decisions/015).
class SequenceVerifier {
 public:
  // Frames younger than the window are never predicted.
  SequenceVerifier(const MeasureSettings& settings, std::uint64_t window_frames);

  // The next frame. Frames ascend.
  void add(const features::View& view, const core::Descriptor& descriptor);

  // Sets evidence.sequence to the numbers of both views where a sequence is needed.
  void number(const core::Candidate& candidate, core::Evidence& evidence) const;

  // The verdict on a candidate: an ambiguous one is pending from now on.
  void record(const core::LedgerRow& row);

  // Candidates that would continue the best sequences at this frame, the last that was added; none
  // with a verdict already.
  std::vector<core::Candidate> predict(const core::Descriptor& descriptor);

  // Later verdicts on pending candidates after this frame, and at the end of the input.
  std::vector<core::LedgerRow> settle(core::FrameId frame);
  std::vector<core::LedgerRow> settle_all() { return pending_.settle_all(); }

 private:
  Config config_;
  std::uint64_t window_frames_;
  NumberedViews numbered_;
  PendingCandidates pending_;
  std::set<std::pair<core::FrameId, core::FrameId>> recorded_;  // query, match
};

}  // namespace samewhere::verify
