#include "withdrawal_effects.hpp"

#include <algorithm>
#include <utility>

#include <samewhere/core/errors.hpp>
#include <samewhere/correct/loop_corrector.hpp>
#include <samewhere/evaluate/trajectory_error.hpp>
#include <samewhere/pipeline/correction.hpp>

namespace samewhere::bench {
namespace {

constexpr double kSamePoint_m = 0.3;

bool has_loop(const scene::MapVersion& map, core::CandidateId cause) {
  return std::any_of(map.loops.begin(), map.loops.end(),
                     [&](const scene::LoopEdge& loop) { return loop.cause == cause; });
}

core::Trajectory keyframe_trajectory(const scene::MapVersion& map) {
  core::Trajectory trajectory;
  for (std::size_t i = 0; i < map.keyframes.size(); ++i)
    trajectory.push_back(
        {map.keyframes[i].view.stamp_s, world_from_body(map, map.keyframes[i].id) *
                                            map.keyframes[i].view.rig->body_from_camera[0]});
  return trajectory;
}

int num_merged_for(const scene::MapVersion& map, core::CandidateId cause) {
  int count = 0;
  for (std::size_t i = 0; i < map.merges.size(); ++i) count += map.merges[i].cause == cause;
  return count;
}

int num_observed_for(const scene::MapVersion& map, core::CandidateId cause) {
  int count = 0;
  for (std::size_t i = 0; i < map.landmarks.size(); ++i)
    for (const auto& o : map.landmarks[i].observations)
      count += is_live(map.landmarks[i]) && o.cause == cause;
  return count;
}

}  // namespace

WithdrawalRecorder::WithdrawalRecorder(const pipeline::Config& config,
                                       const FalseLoopInjector& injector, core::Truth truth)
    : config_(config), injector_(injector), truth_(std::move(truth)) {}

void WithdrawalRecorder::receive_affected_map(const scene::MapVersion& map) {
  if (!injector_.false_loop() || effects_.withdrawn_at) return;
  if (has_loop(map, injector_.false_loop()->loop.cause)) {
    effects_.is_accepted = true;
    accepted_ = map;
  } else if (effects_.is_accepted) {
    measure_accepted();
    measure_withdrawal();
  }
}

void WithdrawalRecorder::measure_accepted() {
  const core::CandidateId cause = injector_.false_loop()->loop.cause;
  effects_.num_merged = num_merged_for(accepted_, cause);
  effects_.num_observed = num_observed_for(accepted_, cause);
  const auto error =
      evaluate::ate(truth_.trajectory, keyframe_trajectory(accepted_), evaluate::Alignment::kSe3);
  if (error) effects_.ate_accepted_m = error->rmse_m;
}

// Mapping applied the true loop before it inserted the next keyframe, and the map of that moment
// was not kept: the correction is repeated here.
void WithdrawalRecorder::measure_withdrawal() {
  const FalseLoop& false_loop = *injector_.false_loop();
  const core::KeyframeId newest = accepted_.keyframes.back().id;
  const auto true_loop = injector_.true_loop_for(accepted_, newest);
  core::require(true_loop.has_value(), "a true loop withdraws the false one");
  const auto after =
      with_loop(accepted_, correct::between_holders(accepted_, *true_loop).value(), config_).map;
  core::require(!has_loop(after, false_loop.loop.cause), "the repeated correction is the same");
  effects_.withdrawn_at = newest.index();
  effects_.num_marked =
      num_merged_for(after, false_loop.loop.cause) + num_observed_for(after, false_loop.loop.cause);
  effects_.num_parted = partition_change(false_loop.before, after).num_parted;
  effects_.joined = joined_in(after);
  effects_.joined_in_reference = joined_in(reference_);
}

JoinedClasses WithdrawalRecorder::joined_in(const scene::MapVersion& map) const {
  const scene::MapVersion& before = injector_.false_loop()->before;
  const auto true_position = [&](core::LandmarkId id) {
    const scene::Landmark& landmark = before.at(id);
    return true_pose(truth_, before, landmark.anchor) * landmark.position_in_anchor;
  };
  const PartitionChange change = partition_change(before, map, FalseLoopInjector::true_causes());
  JoinedClasses joined{change.num_joined};
  for (const auto& parts : change.joined)
    for (std::size_t i = 1; i < parts.size(); ++i)
      joined.num_wrong += (true_position(parts[i]) - true_position(parts[0])).norm() > kSamePoint_m;
  return joined;
}

}  // namespace samewhere::bench
