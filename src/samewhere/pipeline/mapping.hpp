#pragma once

#include <map>
#include <string>

#include <samewhere/core/timing.hpp>
#include <samewhere/correct/loop_corrector.hpp>
#include <samewhere/pipeline/config.hpp>
#include <samewhere/pipeline/full_bundles.hpp>
#include <samewhere/pipeline/messages.hpp>
#include <samewhere/scene/landmark_pages.hpp>

namespace samewhere::pipeline {

// The second stage: what does a new view add to the map? Owns the map.
class Mapping {
 public:
  // The map so far may be empty. The stages that it asks outlive this.
  struct Asks {
    LoopLink& loops;
    BundleLink& bundling;
  };
  Mapping(const Config& config, scene::MapVersion so_far, const Asks& asks, KeepMap keep_map);
  Mapping(const Mapping&) = delete;
  Mapping& operator=(const Mapping&) = delete;

  // Does what a message of tracking asks for, and refines the map after the answer.
  void take(const ToMapping& message, const MappingLink::Reply& reply);

  const scene::MapVersion& map() const { return map_; }
  // Later verdicts of the pose graph on accepted loops, in the order of time.
  const core::Ledger& later_verdicts() const { return later_verdicts_; }
  // Rows that came after the last answer.
  const core::Ledger& unsent_rows() const { return unsent_rows_; }
  const core::Timings& timings() const { return timings_; }

 private:
  void take(const StartMap& message, const MappingLink::Reply& reply);
  void take(const StartMapByMotion& message, const MappingLink::Reply& reply);
  void take(const AddKeyframe& message, const MappingLink::Reply& reply);
  void take(const FindPlace& message, const MappingLink::Reply& reply);
  void take(const SaveFrames& message, const MappingLink::Reply& reply);
  void take(const EndOfInput& message, const MappingLink::Reply& reply);

  // What the map showed so far is no longer part of it.
  void give_up_map();
  // Points between the newest keyframe and its neighbours, landmarks that are one.
  void connect_newest();
  // Better poses and points around the newest keyframe; then what proved to be no good goes.
  void refine_newest();
  // Have I seen this place before? The answer is heard later.
  void ask_for_loops(const cv::Mat& image, bool starts_map = false);
  // What the loops of the map decide of the candidates that wait, until they decide no more.
  void close_waiting_loops();
  // Loop closing's answers until so few are still to come; each corrects the past. Whether places
  // that were one were parted.
  bool hear_loops(int max_unheard);
  void note(const LoopAnswer& answer);
  bool correct(const AcceptedLoop& heard);
  // The same loop, if it is one still: it was accepted on a map with other accepted loops.
  std::optional<AcceptedLoop> reverified(AcceptedLoop heard);
  // Verdicts of the pose graph on accepted loops, for the ledger.
  void record_changes(const correct::Closing& closing, const scene::LoopEdge& newest);
  void reject(const scene::LoopEdge& loop, core::Refusal stage, const std::string& reason);
  void accept_again(const scene::LoopEdge& loop);
  void add_row(const core::LedgerRow& row);
  MapAnswer newest_answer(std::vector<Place> places = {});

  void add_frames(const std::vector<core::FramePose>& frames);
  void keep_map();
  void apply(scene::Edit edit);
  void let_old_leave_memory();

  Config config_;
  core::Timings timings_;
  LoopLink& loops_;
  FullBundles full_bundles_;
  KeepMap keep_map_;
  scene::MapVersion map_;
  core::PagedMemory feature_memory_;
  scene::LandmarkPages landmark_pages_;
  std::uint64_t withdrawn_at_ = 0;  // MapVersion::number when a loop was withdrawn last
  int num_unheard_ = 0;             // questions to loop closing whose answers are to come
  MapNews news_;                    // since the map was kept
  std::map<core::CandidateId, core::LedgerRow> accepted_;  // by the loop verifier, in this session
  core::Ledger later_verdicts_;
  core::Ledger unsent_rows_;
};

}  // namespace samewhere::pipeline
