#pragma once

#include <optional>
#include <set>

#include <samewhere/core/truth.hpp>
#include <samewhere/pipeline/config.hpp>
#include <samewhere/pipeline/messages.hpp>

namespace samewhere::bench {

// A false loop closure between look-alike places: geometric verification accepted it, the odometry
// gate rejected it.
struct FalseLoop {
  scene::LoopEdge loop;
  double error_m = 0.0;      // from the true relative pose
  std::uint64_t query = 0;   // index of its keyframe
  scene::MapVersion before;  // without the loop
};

// True pose of the body of a keyframe, in the world of the truth.
core::Rigid3 true_pose(const core::Truth& truth, const scene::MapVersion& map, core::KeyframeId id);

// Replaces the loops that loop closing accepts: one false loop closure and, so that it can be
// rejected, true ones between places near it soon after. No others.
class FalseLoopInjector {
 public:
  // Injects once the map has `inject_after` keyframes: the first candidate that the odometry gate
  // rejects and whose relative pose is wrong by 0.5 to 6 m.
  FalseLoopInjector(const pipeline::Config& config, int inject_after, core::Truth truth);

  void answer(const pipeline::ToLoopClosing& question, pipeline::LoopAnswer& answer);
  // For the reference run: the same true loops, without the false one.
  void answer_with_true_loops(const pipeline::ToLoopClosing& question,
                              pipeline::LoopAnswer& answer) const;

  const std::optional<FalseLoop>& false_loop() const { return false_loop_; }
  // The true loop that is the answer for that keyframe, in that map.
  std::optional<scene::LoopEdge> true_loop_for(const scene::MapVersion& map,
                                               core::KeyframeId query) const;
  // Index of the keyframe of the last true loop, or of the map's last keyframe if the map ends
  // before; requires a false loop.
  std::size_t last_true_loop_at(const scene::MapVersion& map) const;
  // Causes of all true loops, whether they were used or not.
  static std::set<core::CandidateId> true_causes();

 private:
  core::Rigid3 true_match_from_query(const scene::MapVersion& map, core::KeyframeId match,
                                     core::KeyframeId query) const;
  void inject(const pipeline::FindLoops& question, pipeline::LoopAnswer& answer);

  pipeline::Config config_;
  int inject_after_ = 0;
  core::Truth truth_;
  std::optional<FalseLoop> false_loop_;
};

}  // namespace samewhere::bench
