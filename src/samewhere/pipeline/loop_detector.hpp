#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include <samewhere/core/ledger.hpp>
#include <samewhere/core/timing.hpp>
#include <samewhere/features/features.hpp>
#include <samewhere/pipeline/config.hpp>
#include <samewhere/pipeline/place_index.hpp>
#include <samewhere/verify/loop_verifier.hpp>
#include <samewhere/verify/map_context.hpp>
#include <samewhere/verify/neighbours.hpp>
#include <samewhere/verify/sequence_verifier.hpp>
#include <samewhere/verify/waiting_candidates.hpp>

namespace samewhere::pipeline {

// Detects loops: retrieves candidates from the place index and verifies each. Numbers the
// candidates, and remembers the views and the last loop.
class LoopDetector {
 public:
  // `settings`: of the role, loop_settings() or recognition_settings(). Throws InputError on
  // settings that do not fit each other.
  LoopDetector(const Config& config, const verify::VerifierSettings& settings);

  // Describes the keyframe, retrieves its candidates and verifies them: steps "describe",
  // "retrieve" and "verify" of the timings. One row each; the keyframe is remembered. Frames
  // ascend.
  std::vector<core::LedgerRow> detect(const cv::Mat& image, const features::View& view,
                                      const verify::MapContext& map, core::Timings& timings);

  // The same for the view of a LOST frame: all remembered views are searched, odometry gives no
  // evidence, and the view is not remembered. Step "relocalize" of the timings.
  std::vector<core::LedgerRow> relocalize(const cv::Mat& image, const features::View& view,
                                          core::Timings& timings);

  // A view that is described already.
  void remember(const core::Descriptor& descriptor, const features::View& view);

  // One row for each candidate, in their order; then of neighbours of the best match, of predicted
  // candidates, and later rows of pending and of waiting ones.
  std::vector<core::LedgerRow> verify(const core::Descriptor& descriptor,
                                      const std::vector<core::Candidate>& candidates,
                                      const features::View& view, const verify::MapContext& map);

  // All candidates that wait are decided again by the loops of this map, whatever
  // verify.asked_again_per_keyframe allows: verdicts that have changed. Step "verify" of the
  // timings.
  std::vector<core::LedgerRow> ask_again(const verify::MapContext& map, core::Timings& timings);

  // The map was given up: nothing of its views is found, predicted or decided any more.
  void forget();

  // The input has ended: the last verdicts on pending candidates.
  std::vector<core::LedgerRow> settle_all() { return sequences_.settle_all(); }

  // Shares no state with verify(), so that its steps can run in threads of their own.
  PlaceIndex& index() { return index_; }
  const PlaceIndex& index() const { return index_; }

 private:
  core::LedgerRow verify_candidate(core::Candidate candidate, const features::View& view,
                                   const verify::MapContext& map);
  // Near the match of the best candidate, for one that shows more of the same.
  void verify_neighbours(const core::Descriptor& descriptor, const features::View& view,
                         const verify::MapContext& map, std::vector<core::LedgerRow>& rows);
  void record(const core::LedgerRow& row);
  core::CandidateId next_id(const features::View& view);

  verify::VerifierSettings settings_;
  std::uint64_t window_frames_;
  PlaceIndex index_;
  verify::LoopVerifier verifier_;
  verify::LoopVerifier relocalization_verifier_;
  verify::SequenceVerifier sequences_;
  verify::Neighbours neighbours_;
  verify::WaitingCandidates waiting_;
  verify::History history_;
  std::map<core::FrameId, features::View> views_;
  std::uint64_t num_candidates_ = 0;
};

}  // namespace samewhere::pipeline
