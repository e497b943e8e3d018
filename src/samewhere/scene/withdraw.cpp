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
        std::erase_if(map.loops, is_of_it) + std::erase_if(map.doubted_loops, is_of_it);
    core::require(cause.is_valid() && num_removed > 0, "a loop that is withdrawn is in the map");
  }
}

// A full bundle rests on all loops that were there, and places every keyframe.
void forget_settled(MapVersion& map, std::uint64_t since) {
  for (std::size_t i = 0; i < map.keyframes.size(); ++i) {
    const Keyframe& keyframe = map.keyframes[i];
    if (keyframe.settled_parent_from_keyframe && keyframe.settled_at >= since)
      map.keyframes.edit(i).settled_parent_from_keyframe.reset();
  }
}

// Keyframes up to the younger one that it joins.
std::size_t num_older(const LoopEdge& loop) { return std::max(loop.query, loop.match).index() + 1; }

void forget_refinements(MapVersion& map, const Causes& causes) {
  for (const auto& loop : map.loops) {
    if (!causes.contains(loop.cause)) continue;
    forget_settled(map, loop.closed_at);
    for (std::size_t i = 0; i < num_older(loop); ++i) {
      const Keyframe& keyframe = map.keyframes[i];
      if (keyframe.refined_parent_from_keyframe && keyframe.refined_at >= loop.closed_at)
        map.keyframes.edit(i).refined_parent_from_keyframe.reset();
    }
  }
}

// What was merged may be taken apart one day, and should then be where it was: it hangs on who may
// still see it, and not on keyframes that are culled, whose poses change below.
void hang_merged_on_the_living(MapVersion& map) {
  for (std::size_t i = 0; i < map.landmarks.size(); ++i) {
    const Landmark& known = map.landmarks[i];
    if (!known.merged_into.is_valid() || is_live(map.at(known.anchor))) continue;
    const auto living =
        std::find_if(known.observations.begin(), known.observations.end(),
                     [&](const Observation& o) { return is_live(map.at(o.keyframe)); });
    if (living == known.observations.end()) continue;
    const core::KeyframeId observer = living->keyframe;
    hang_on(map, map.landmarks.edit(i), observer);
  }
}

// Of those that were culled while the loop was there the way to the parent may be what it had bent.
// Nobody wrote down when they were: those culled before stand as measured, too.
void let_culled_stand_as_measured(MapVersion& map, std::size_t num_keyframes) {
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
    hang_on_observer(map, landmark);
    look_as_seen(map, landmark, landmark.observations.back());
  }
}

// Follows how landmarks became one after another. `to` stands for the whole that came out of a
// merge until it is merged itself.
class Merging {
 public:
  explicit Merging(std::vector<LoopEdge> withdrawn) : withdrawn_(std::move(withdrawn)) {
    known_to_.resize(withdrawn_.size());
  }

  // Whether the merge is one that mapping alone made while a withdrawn loop was there, of two
  // wholes that both were, in part, there before that loop.
  bool is_of_known(const Merge& made) const {
    if (made.cause.is_valid()) return false;
    for (std::size_t i = 0; i < withdrawn_.size(); ++i)
      if (made.made_at >= withdrawn_[i].closed_at && is_known(i, made.from) && is_known(i, made.to))
        return true;
    return false;
  }

  // The merge stays.
  void note(const Merge& made) {
    for (std::size_t i = 0; i < withdrawn_.size(); ++i)
      if (is_known(i, made.from)) known_to_[i].insert(made.to);
  }

 private:
  bool is_known(std::size_t loop, core::LandmarkId id) const {
    return id.index() < withdrawn_[loop].num_landmarks_then || known_to_[loop].contains(id);
  }

  std::vector<LoopEdge> withdrawn_;
  std::vector<std::set<core::LandmarkId>> known_to_;  // per loop: younger ones with an older part
};

std::vector<LoopEdge> believed_of(const MapVersion& map, const Causes& causes) {
  std::vector<LoopEdge> loops;
  std::copy_if(map.loops.begin(), map.loops.end(), std::back_inserter(loops),
               [&](const LoopEdge& loop) { return causes.contains(loop.cause); });
  return loops;
}

// Per merge of the map.
std::vector<bool> merges_to_take_back(const MapVersion& map, const Causes& causes,
                                      const std::vector<core::LandmarkId>& unmerged) {
  const std::set<core::LandmarkId> named(unmerged.begin(), unmerged.end());
  std::set<core::LandmarkId> doubtful;  // wholes with a part that is taken back
  Merging merging(believed_of(map, causes));
  std::vector<bool> is_taken_back;
  for (std::size_t i = 0; i < map.merges.size(); ++i) {
    const Merge& made = map.merges[i];
    is_taken_back.push_back(causes.contains(made.cause) || named.contains(made.from) ||
                            doubtful.contains(made.from) || doubtful.contains(made.to) ||
                            merging.is_of_known(made));
    if (is_taken_back.back()) {
      doubtful.insert(made.to);
    } else {
      merging.note(made);
    }
  }
  return is_taken_back;
}

// What a culled landmark still can show it shows again.
void revive(MapVersion& map, core::LandmarkId id) {
  if (!map.at(id).is_culled) return;
  Landmark& landmark = map.landmarks.edit(id.index());
  std::erase_if(landmark.observations, [&](const Observation& o) {
    return !is_live(map.at(o.keyframe)) || shown_at(map, o).is_valid();
  });
  for (const auto& o : landmark.observations) set_slot(map, o, id);
  landmark.is_culled = landmark.observations.empty();
  hang_on_observer(map, landmark);
}

// Whoever shows there does so no longer.
void free_slot(MapVersion& map, const Observation& observation) {
  const core::LandmarkId shown = shown_at(map, observation);
  if (!shown.is_valid()) return;
  Landmark& landmark = map.landmarks.edit(shown.index());
  std::erase_if(landmark.observations,
                [&](const Observation& o) { return o.keyframe == observation.keyframe; });
  landmark.is_culled = landmark.observations.empty();
  hang_on_observer(map, landmark);
  set_slot(map, observation, core::LandmarkId{});
}

// The later merges of both are taken back already: `to` is merged into nobody.
void take_back(MapVersion& map, const Merge& made) {
  revive(map, made.to);
  Landmark& from = map.landmarks.edit(made.from.index());
  core::require(from.merged_into == made.to, "a merge that is taken back is the last of its kind");
  std::erase_if(from.observations,
                [&](const Observation& o) { return !is_live(map.at(o.keyframe)); });
  for (const auto& o : from.observations) {
    free_slot(map, o);
    set_slot(map, o, made.from);
  }
  from.merged_into = core::LandmarkId{};
  from.is_culled = from.observations.empty();
  hang_on_observer(map, from);
}

void take_back(MapVersion& map, const std::vector<bool>& is_taken_back) {
  std::vector<Merge> kept;
  for (std::size_t i = 0; i < is_taken_back.size(); ++i)
    if (!is_taken_back[i]) kept.push_back(map.merges[i]);
  for (std::size_t i = is_taken_back.size(); i-- > 0;)
    if (is_taken_back[i]) take_back(map, map.merges[i]);
  const auto first = std::find(is_taken_back.begin(), is_taken_back.end(), true);
  const auto num_before = static_cast<std::size_t>(first - is_taken_back.begin());
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
  forget_refinements(map, causes);
  const std::vector<bool> is_taken_back = merges_to_take_back(map, causes, unmerged);
  remove_edges(map, causes);
  if (!causes.empty())
    for (std::size_t i = 0; i < map.landmarks.size(); ++i) remove_observations(map, causes, i);
  take_back(map, is_taken_back);
  if (causes.empty()) return;
  hang_merged_on_the_living(map);
  let_culled_stand_as_measured(map, num_older_keyframes);
}

}  // namespace samewhere::scene
