#pragma once

#include <optional>

#include "false_loops.hpp"
#include "partition.hpp"

namespace samewhere::bench {

// Classes of landmarks from before the false loop that mapping alone has joined since, without what
// the true loops merged.
struct JoinedClasses {
  int num_all = 0;
  int num_wrong = 0;  // of these, of points more than 0.3 m apart in truth
};

// Effects of a false loop closure on the map, while it is accepted and at its withdrawal.
struct WithdrawalEffects {
  bool is_accepted = false;     // by the pose graph, for at least one keyframe
  int num_merged = 0;           // landmarks, while it was accepted
  int num_observed = 0;         // observations of landmarks that were added because of it
  double ate_accepted_m = 0.0;  // of the keyframes, before it was withdrawn

  // From here on: the map at its withdrawal, before mapping goes on.
  std::optional<std::uint64_t> withdrawn_at;  // index of the newest keyframe
  int num_marked = 0;                         // merges and observations that still name it as cause
  int num_parted = 0;                         // classes of landmarks from before
  JoinedClasses joined;
  JoinedClasses joined_in_reference;  // in the run without the false loop
};

// Compares the maps of two runs over the same frames: one with a false loop closure, and the
// reference run without it.
class WithdrawalRecorder {
 public:
  WithdrawalRecorder(const pipeline::Config& config, const FalseLoopInjector& injector,
                     core::Truth truth);
  WithdrawalRecorder(const WithdrawalRecorder&) = delete;
  WithdrawalRecorder& operator=(const WithdrawalRecorder&) = delete;

  // Each version of both maps; of one frame that with the false loop first.
  void receive_affected_map(const scene::MapVersion& map);
  void receive_reference_map(const scene::MapVersion& map) { reference_ = map; }

  const WithdrawalEffects& effects() const { return effects_; }
  // From before the false loop to `map`, a later version.
  JoinedClasses joined_in(const scene::MapVersion& map) const;

 private:
  void measure_accepted();
  void measure_withdrawal();

  pipeline::Config config_;
  const FalseLoopInjector& injector_;
  core::Truth truth_;
  scene::MapVersion accepted_;   // the last with the false loop
  scene::MapVersion reference_;  // the last
  WithdrawalEffects effects_;
};

}  // namespace samewhere::bench
