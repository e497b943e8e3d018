#include <algorithm>
#include <iterator>
#include <set>
#include <utility>

#include <samewhere/core/errors.hpp>
#include <samewhere/scene/observations.hpp>
#include <samewhere/scene/withdraw.hpp>

namespace samewhere::scene {
namespace {

using Causes = std::set<core::CandidateId>;

void remove_edges(MapVersion& map, const Causes& causes) {
  for (const auto& cause : causes) {
    const auto is_of_it = [&](const LoopEdge& loop) { return loop.cause == cause; };
    const std::size_t num_removed =
        std::erase_if(map.loops, is_of_it) + std::erase_if(map.suspended_loops, is_of_it);
    core::require(cause.is_valid() && num_removed > 0, "a loop that is withdrawn is in the map");
  }
}

// Full bundle adjustment uses all loops of its time and moves every keyframe.
void drop_full_bundles(MapVersion& map, std::uint64_t since) {
  for (std::size_t i = 0; i < map.keyframes.size(); ++i) {
    const Keyframe& keyframe = map.keyframes[i];
    if (keyframe.settled_parent_from_keyframe && keyframe.settled_at >= since)
      map.keyframes.edit(i).settled_parent_from_keyframe.reset();
  }
}

// Number of keyframes up to the younger end of the loop.
std::size_t num_older(const LoopEdge& loop) { return std::max(loop.query, loop.match).index() + 1; }

void drop_local_bundles(MapVersion& map, const Causes& causes) {
  for (const auto& loop : map.loops) {
    if (!causes.contains(loop.cause)) continue;
    drop_full_bundles(map, loop.closed_at);
    for (std::size_t i = 0; i < num_older(loop); ++i) {
      const Keyframe& keyframe = map.keyframes[i];
      if (keyframe.refined_parent_from_keyframe && keyframe.refined_at >= loop.closed_at)
        map.keyframes.edit(i).refined_parent_from_keyframe.reset();
    }
  }
}

// Anchors merged landmarks to live observers instead of culled keyframes, whose poses change below:
// if their merge is undone later, their position is still the one from before.
void anchor_merged_to_live(MapVersion& map) {
  for (std::size_t i = 0; i < map.landmarks.size(); ++i) {
    const Landmark& known = map.landmarks[i];
    if (!known.merged_into.is_valid() || is_live(map.at(known.anchor))) continue;
    const auto observer =
        std::find_if(known.observations.begin(), known.observations.end(),
                     [&](const Observation& o) { return is_live(map.at(o.keyframe)); });
    if (observer == known.observations.end()) continue;
    const core::KeyframeId anchor = observer->keyframe;
    anchor_to(map, map.landmarks.edit(i), anchor);
  }
}

// A keyframe culled while the loop was in the map has a relative pose that the loop distorted. When
// it was culled is not recorded, so all of them return to odometry.
void return_culled_to_odometry(MapVersion& map, std::size_t num_keyframes) {
  for (std::size_t i = 0; i < num_keyframes; ++i) {
    if (is_live(map.keyframes[i])) continue;
    Keyframe& keyframe = map.keyframes.edit(i);
    keyframe.culled_parent_from_keyframe = parent_from_keyframe(keyframe);
  }
}

// Slots of live landmarks go with their observations; merged and culled ones have none.
void remove_observations(MapVersion& map, const Causes& causes, std::size_t landmark_index) {
  const auto is_caused = [&](const Observation& o) { return causes.contains(o.cause); };
  const auto& known = map.landmarks[landmark_index].observations;
  if (std::none_of(known.begin(), known.end(), is_caused)) return;
  Landmark& landmark = map.landmarks.edit(landmark_index);
  const bool was_live = is_live(landmark);
  for (const auto& o : landmark.observations)
    if (was_live && is_caused(o)) set_slot(map, o, core::LandmarkId{});
  std::erase_if(landmark.observations, is_caused);
  if (landmark.observations.empty()) {
    landmark.is_culled = landmark.is_culled || was_live;
  } else if (was_live) {
    anchor_to_observer(map, landmark);
    set_appearance(map, landmark, landmark.observations.back());
  }
}

// Replays the merges in their order. `to` names the merged landmark until it is merged itself.
class MergeHistory {
 public:
  explicit MergeHistory(std::vector<LoopEdge> withdrawn) : withdrawn_(std::move(withdrawn)) {
    known_to_.resize(withdrawn_.size());
  }

  // Whether mapping made the merge while a withdrawn loop was in the map, of two landmarks that
  // both contain ones from before that loop.
  bool is_of_known(const Merge& made) const {
    if (made.cause.is_valid()) return false;
    for (std::size_t i = 0; i < withdrawn_.size(); ++i)
      if (made.made_at >= withdrawn_[i].closed_at && is_known(i, made.from) && is_known(i, made.to))
        return true;
    return false;
  }

  // A merge that is not undone.
  void add(const Merge& made) {
    for (std::size_t i = 0; i < withdrawn_.size(); ++i)
      if (is_known(i, made.from)) known_to_[i].insert(made.to);
  }

 private:
  bool is_known(std::size_t loop, core::LandmarkId id) const {
    return id.index() < withdrawn_[loop].num_landmarks_then || known_to_[loop].contains(id);
  }

  std::vector<LoopEdge> withdrawn_;
  std::vector<std::set<core::LandmarkId>>
      known_to_;  // per loop: younger ones that contain an older one
};

std::vector<LoopEdge> accepted_of(const MapVersion& map, const Causes& causes) {
  std::vector<LoopEdge> loops;
  std::copy_if(map.loops.begin(), map.loops.end(), std::back_inserter(loops),
               [&](const LoopEdge& loop) { return causes.contains(loop.cause); });
  return loops;
}

// Whether each merge of the map is undone.
std::vector<bool> find_merges_to_undo(const MapVersion& map, const Causes& causes,
                                      const std::vector<core::LandmarkId>& unmerged) {
  const std::set<core::LandmarkId> named(unmerged.begin(), unmerged.end());
  std::set<core::LandmarkId> affected;  // took part in a merge that is undone
  MergeHistory history(accepted_of(map, causes));
  std::vector<bool> is_undone;
  for (std::size_t i = 0; i < map.merges.size(); ++i) {
    const Merge& made = map.merges[i];
    is_undone.push_back(causes.contains(made.cause) || named.contains(made.from) ||
                        affected.contains(made.from) || affected.contains(made.to) ||
                        history.is_of_known(made));
    if (is_undone.back()) {
      affected.insert(made.to);
    } else {
      history.add(made);
    }
  }
  return is_undone;
}

// Restores a culled landmark with its observations of free features.
void restore(MapVersion& map, core::LandmarkId id) {
  if (!map.at(id).is_culled) return;
  Landmark& landmark = map.landmarks.edit(id.index());
  std::erase_if(landmark.observations, [&](const Observation& o) {
    return !is_live(map.at(o.keyframe)) || shown_at(map, o).is_valid();
  });
  for (const auto& o : landmark.observations) set_slot(map, o, id);
  landmark.is_culled = landmark.observations.empty();
  anchor_to_observer(map, landmark);
}

// Removes the observation of the landmark that the feature shows.
void free_slot(MapVersion& map, const Observation& observation) {
  const core::LandmarkId shown = shown_at(map, observation);
  if (!shown.is_valid()) return;
  Landmark& landmark = map.landmarks.edit(shown.index());
  std::erase_if(landmark.observations,
                [&](const Observation& o) { return o.keyframe == observation.keyframe; });
  landmark.is_culled = landmark.observations.empty();
  anchor_to_observer(map, landmark);
  set_slot(map, observation, core::LandmarkId{});
}

// The later merges of both are undone already: `to` is not merged.
void undo(MapVersion& map, const Merge& made) {
  restore(map, made.to);
  Landmark& from = map.landmarks.edit(made.from.index());
  core::require(from.merged_into == made.to, "a merge that is undone is the last of its landmark");
  std::erase_if(from.observations,
                [&](const Observation& o) { return !is_live(map.at(o.keyframe)); });
  for (const auto& o : from.observations) {
    free_slot(map, o);
    set_slot(map, o, made.from);
  }
  from.merged_into = core::LandmarkId{};
  from.is_culled = from.observations.empty();
  anchor_to_observer(map, from);
}

void undo_merges(MapVersion& map, const std::vector<bool>& is_undone) {
  std::vector<Merge> kept;
  for (std::size_t i = 0; i < is_undone.size(); ++i)
    if (!is_undone[i]) kept.push_back(map.merges[i]);
  for (std::size_t i = is_undone.size(); i-- > 0;)
    if (is_undone[i]) undo(map, map.merges[i]);
  const auto first = std::find(is_undone.begin(), is_undone.end(), true);
  const auto num_before = static_cast<std::size_t>(first - is_undone.begin());
  map.merges.shrink(num_before);
  for (std::size_t i = num_before; i < kept.size(); ++i) map.merges.push_back(kept[i]);
}

}  // namespace

void withdraw(MapVersion& map, const std::vector<core::CandidateId>& loops,
              const std::vector<core::LandmarkId>& unmerged) {
  if (loops.empty() && unmerged.empty()) return;
  for (const auto& id : unmerged)
    core::require(map.at(id).merged_into.is_valid(), "a landmark that is unmerged was merged");
  const Causes causes(loops.begin(), loops.end());
  std::size_t num_older_keyframes = 0;
  for (const auto& loop : map.loops)
    if (causes.contains(loop.cause))
      num_older_keyframes = std::max(num_older_keyframes, num_older(loop));
  drop_local_bundles(map, causes);
  const std::vector<bool> is_undone = find_merges_to_undo(map, causes, unmerged);
  remove_edges(map, causes);
  if (!causes.empty())
    for (std::size_t i = 0; i < map.landmarks.size(); ++i) remove_observations(map, causes, i);
  undo_merges(map, is_undone);
  if (causes.empty()) return;
  anchor_merged_to_live(map);
  return_culled_to_odometry(map, num_older_keyframes);
}

}  // namespace samewhere::scene
