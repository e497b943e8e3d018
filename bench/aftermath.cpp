#include "aftermath.hpp"

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

int num_seen_for(const scene::MapVersion& map, core::CandidateId cause) {
  int count = 0;
  for (std::size_t i = 0; i < map.landmarks.size(); ++i)
    for (const auto& o : map.landmarks[i].observations)
      count += is_live(map.landmarks[i]) && o.cause == cause;
  return count;
}

}  // namespace

Witness::Witness(const pipeline::Config& config, const Liar& liar, core::Truth truth)
    : config_(config), liar_(liar), truth_(std::move(truth)) {}

void Witness::see_believer(const scene::MapVersion& map) {
  if (!liar_.lie() || aftermath_.withdrawn_at) return;
  if (has_loop(map, liar_.lie()->loop.cause)) {
    aftermath_.is_believed = true;
    believed_ = map;
  } else if (aftermath_.is_believed) {
    look_at_believed();
    look_at_withdrawal();
  }
}

void Witness::look_at_believed() {
  const core::CandidateId cause = liar_.lie()->loop.cause;
  aftermath_.num_merged = num_merged_for(believed_, cause);
  aftermath_.num_seen = num_seen_for(believed_, cause);
  const auto error =
      evaluate::ate(truth_.trajectory, keyframe_trajectory(believed_), evaluate::Alignment::kSe3);
  if (error) aftermath_.ate_believed_m = error->rmse_m;
}

// Mapping heard the true loop before it added the next keyframe: what it did then is done again,
// for that moment's map was not kept.
void Witness::look_at_withdrawal() {
  const Lie& lie = *liar_.lie();
  const core::KeyframeId newest = believed_.keyframes.back().id;
  const auto told = liar_.truth_for(believed_, newest);
  core::require(told.has_value(), "a true loop has a lie withdrawn");
  const auto after =
      with_loop(believed_, correct::between_holders(believed_, *told).value(), config_).map;
  core::require(!has_loop(after, lie.loop.cause), "what was done again ends alike");
  aftermath_.withdrawn_at = newest.index();
  aftermath_.num_marked =
      num_merged_for(after, lie.loop.cause) + num_seen_for(after, lie.loop.cause);
  aftermath_.num_parted = partition_change(lie.before, after).num_parted;
  aftermath_.joined = joined_in(after);
  aftermath_.joined_meanwhile = joined_in(honest_);
}

Joined Witness::joined_in(const scene::MapVersion& map) const {
  const scene::MapVersion& before = liar_.lie()->before;
  const auto in_truth = [&](core::LandmarkId id) {
    const scene::Landmark& landmark = before.at(id);
    return true_pose(truth_, before, landmark.anchor) * landmark.position_in_anchor;
  };
  const PartitionChange change = partition_change(before, map, Liar::true_causes());
  Joined joined{change.num_joined};
  for (const auto& parts : change.joined)
    for (std::size_t i = 1; i < parts.size(); ++i)
      joined.num_wrong += (in_truth(parts[i]) - in_truth(parts[0])).norm() > kSamePoint_m;
  return joined;
}

}  // namespace samewhere::bench
