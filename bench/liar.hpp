#pragma once

#include <optional>
#include <set>

#include <samewhere/core/truth.hpp>
#include <samewhere/pipeline/config.hpp>
#include <samewhere/pipeline/messages.hpp>

namespace samewhere::bench {

// A wrong loop: geometry found it in two views that look alike, odometry had it refused.
struct Lie {
  scene::LoopEdge loop;
  double error_m = 0.0;        // from the true relative pose
  std::uint64_t asked_at = 0;  // keyframe
  scene::MapVersion before;    // as it was asked
};

// Where a keyframe's body truly was.
core::Rigid3 true_pose(const core::Truth& truth, const scene::MapVersion& map, core::KeyframeId id);

// Says instead of loop closing which loops there are: a lie, and, so that it can be found out, true
// ones between the places around it soon after. No others.
class Liar {
 public:
  // Lies once `lie_after` keyframes are there, as soon as odometry has saved the judge from a loop
  // that is off by half a metre or more, and by no more than a few.
  Liar(const pipeline::Config& config, int lie_after, core::Truth truth);

  void answer(const pipeline::ToLoopClosing& question, pipeline::LoopAnswer& answer);
  // To somebody who walks beside the one who is lied to: the same true loops, and no lie.
  void answer_honestly(const pipeline::ToLoopClosing& question, pipeline::LoopAnswer& answer) const;

  const std::optional<Lie>& lie() const { return lie_; }
  // The true loop told to the question of that keyframe, in that map.
  std::optional<scene::LoopEdge> truth_for(const scene::MapVersion& map,
                                           core::KeyframeId query) const;
  // The keyframe of the last true loop, or of the map if that ends before; once there is a lie.
  std::size_t last_truth_at(const scene::MapVersion& map) const;
  // Causes of all true loops, told or not.
  static std::set<core::CandidateId> true_causes();

 private:
  core::Rigid3 true_match_from_query(const scene::MapVersion& map, core::KeyframeId match,
                                     core::KeyframeId query) const;
  void tell_lie(const pipeline::FindLoops& question, pipeline::LoopAnswer& answer);

  pipeline::Config config_;
  int lie_after_ = 0;
  core::Truth truth_;
  std::optional<Lie> lie_;
};

}  // namespace samewhere::bench
