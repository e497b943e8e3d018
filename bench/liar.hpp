#pragma once

#include <optional>
#include <vector>

#include <samewhere/core/truth.hpp>
#include <samewhere/pipeline/config.hpp>
#include <samewhere/pipeline/messages.hpp>

namespace samewhere::bench {

// A wrong loop: geometry found it in two views that look alike, odometry had it refused.
struct Lie {
  scene::LoopEdge loop;
  double error_m = 0.0;        // from the true relative pose
  std::uint64_t asked_at = 0;  // keyframe
};

// What a lie left behind, at the first keyframe after it was withdrawn.
struct Aftermath {
  int num_merged = 0;                         // landmarks, while it was believed
  int num_seen = 0;                           // landmarks in keyframes that did not know
  std::optional<std::uint64_t> withdrawn_at;  // keyframe
  int num_not_restored =
      0;  // landmarks from before that bear its mark or left who they were one with
  int num_later_merges = 0;     // of two landmarks from before, made since and still there
  int num_wrong_merges = 0;     // of these, of points more than 0.3 m apart
  double ate_believed_m = 0.0;  // of the keyframes, before it was withdrawn
};

// Says instead of loop closing which loops there are: a lie, and, so that it can be found out, true
// ones between the places around it soon after. No others.
class Liar {
 public:
  // Lies once `lie_after` keyframes are there, as soon as odometry has saved the judge from a loop
  // that is off by half a metre or more, and by no more than a few.
  Liar(const pipeline::Config& config, int lie_after);
  // Says the same true loops as after that lie, and does not lie.
  Liar(const pipeline::Config& config, const Lie& untold);

  void begin(const core::Truth& truth) { truth_ = truth; }
  void answer(const pipeline::ToLoopClosing& question, pipeline::LoopAnswer& answer);
  void see(const scene::MapVersion& map);

  const std::optional<Lie>& lie() const { return lie_; }
  const Aftermath& aftermath() const { return aftermath_; }

 private:
  core::Rigid3 true_pose(const scene::MapVersion& map, core::KeyframeId id) const;
  core::Rigid3 true_match_from_query(const scene::MapVersion& map, core::KeyframeId match,
                                     core::KeyframeId query) const;
  void tell_lie(const pipeline::FindLoops& question, pipeline::LoopAnswer& answer);
  void tell_truth(const pipeline::FindLoops& question, pipeline::LoopAnswer& answer) const;
  void compare(const scene::MapVersion& map);

  pipeline::Config config_;
  int lie_after_ = 0;
  bool is_honest_ = false;
  core::Truth truth_;
  std::optional<Lie> lie_;
  scene::MapVersion before_;    // as it was asked
  scene::MapVersion believed_;  // the last with the lie
  Aftermath aftermath_;
};

}  // namespace samewhere::bench
