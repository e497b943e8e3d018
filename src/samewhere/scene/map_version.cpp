#include <algorithm>
#include <cmath>
#include <map>

#include <samewhere/core/errors.hpp>
#include <samewhere/geometry/uncertain_pose.hpp>
#include <samewhere/scene/map_version.hpp>
#include <samewhere/scene/observations.hpp>
#include <samewhere/scene/rescale.hpp>
#include <samewhere/scene/withdraw.hpp>

namespace samewhere::scene {
namespace {

// The new observation sets the landmark's descriptor; its depth, if it has one, is averaged into
// the position.
void add_observation(MapVersion& map, const Sighting& sighting) {
  Landmark& landmark = map.landmarks.edit(sighting.landmark.index());
  const Keyframe& keyframe = map.at(sighting.observation.keyframe);
  core::require(static_cast<std::size_t>(sighting.observation.slot) < keyframe.slots.size(),
                "an observation names a slot of its keyframe");
  core::require(is_live(landmark) && is_live(keyframe),
                "an observation joins a live landmark and a live keyframe");
  if (const auto point = features::point_in_camera(keyframe.view, sighting.observation.slot)) {
    const double weight = weight_of_depth(point->z());
    const core::Rigid3 anchor_from_body =
        inverse(world_from_body(map, landmark.anchor)) * keyframe.world_from_body;
    const Eigen::Vector3d seen_at =
        anchor_from_body * (keyframe.view.rig->body_from_camera[0] * *point);
    landmark.position_in_anchor =
        (landmark.weight * landmark.position_in_anchor + weight * seen_at) /
        (landmark.weight + weight);
    landmark.weight += weight;
  }
  set_appearance(map, landmark, sighting.observation);
  landmark.observations.push_back(sighting.observation);
  set_slot(map, sighting.observation, landmark.id);
}

// A landmark without observations is culled.
void remove_observation(MapVersion& map, const RemovedObservation& removed) {
  Landmark& landmark = map.landmarks.edit(removed.landmark.index());
  auto& observations = landmark.observations;
  const auto found =
      std::find_if(observations.begin(), observations.end(),
                   [&](const Observation& o) { return o.keyframe == removed.keyframe; });
  core::require(found != observations.end(), "an observation that is removed was there");
  set_slot(map, *found, core::LandmarkId{});
  observations.erase(found);
  landmark.is_culled = observations.empty();
}

// The survivor takes over the observations of the other, except in keyframes that observe it
// itself.
void merge(MapVersion& map, const Merge& merge) {
  core::require(merge.from != merge.to && is_live(map.at(merge.from)) && is_live(map.at(merge.to)),
                "two landmarks that the map shows are merged");
  Landmark& to = map.landmarks.edit(merge.to.index());
  Landmark& from = map.landmarks.edit(merge.from.index());
  for (const auto& observation : from.observations) {
    const bool is_observed =
        std::any_of(to.observations.begin(), to.observations.end(),
                    [&](const Observation& o) { return o.keyframe == observation.keyframe; });
    set_slot(map, observation, is_observed ? core::LandmarkId{} : to.id);
    if (!is_observed) to.observations.push_back(observation);
  }
  from.merged_into = to.id;
  map.merges.push_back({merge.from, merge.to, merge.cause, map.number});
}

void cull(MapVersion& map, core::LandmarkId id) {
  Landmark& landmark = map.landmarks.edit(id.index());
  if (is_live(landmark)) {
    for (const auto& observation : landmark.observations)
      set_slot(map, observation, core::LandmarkId{});
  }
  landmark.is_culled = true;
}

// The odometry of the child becomes that to its grandparent.
void skip_parent(const MapVersion& map, Keyframe& child) {
  const Keyframe& parent = map.at(child.odometry->parent);
  const auto edge_of = [](const OdometryEdge& edge) {
    return geometry::UncertainPose{edge.parent_from_keyframe, edge.information.inverse()};
  };
  const auto joined = compose(edge_of(*parent.odometry), edge_of(*child.odometry));
  if (parent.settled_parent_from_keyframe || child.settled_parent_from_keyframe) {
    child.settled_parent_from_keyframe =
        settled_parent_from_keyframe(parent) * settled_parent_from_keyframe(child);
    child.settled_at =
        std::max({parent.settled_at, child.settled_at, parent.refined_at, child.refined_at});
  }
  if (parent.refined_parent_from_keyframe || child.refined_parent_from_keyframe)
    child.refined_parent_from_keyframe = parent_from_keyframe(parent) * parent_from_keyframe(child);
  child.refined_at = std::max(parent.refined_at, child.refined_at);
  child.odometry = {parent.odometry->parent, joined.a_from_b, joined.covariance.inverse()};
}

void cull(MapVersion& map, core::KeyframeId id) {
  Keyframe& keyframe = map.keyframes.edit(id.index());
  core::require(keyframe.odometry.has_value(), "a culled keyframe has an odometry parent");
  core::require(std::none_of(map.loops.begin(), map.loops.end(),
                             [&](const LoopEdge& l) { return l.query == id || l.match == id; }),
                "a keyframe with a loop edge is not culled");
  for (std::size_t slot = 0; slot < keyframe.slots.size(); ++slot) {
    const core::LandmarkId shown = keyframe.slots[slot];
    if (!shown.is_valid()) continue;
    remove_observation(map, {shown, id});
    anchor_to_observer(map, map.landmarks.edit(shown.index()));
  }
  keyframe.culled_parent_from_keyframe =
      inverse(world_from_body(map, keyframe.odometry->parent)) * keyframe.world_from_body;
  for (std::size_t i = id.index() + 1; i < map.keyframes.size(); ++i) {
    const Keyframe& child = map.keyframes[i];
    if (is_live(child) && child.odometry && child.odometry->parent == id)
      skip_parent(map, map.keyframes.edit(i));
  }
}

// Measured in the scale from before the edit: added before rescale_around() corrects it.
void add_loops(MapVersion& map, const Edit& edit) {
  map.suspended_loops.insert(map.suspended_loops.end(), edit.suspended_loops.begin(),
                             edit.suspended_loops.end());
  for (const auto& loop : edit.loops) {
    std::erase_if(map.suspended_loops, [&](const LoopEdge& o) { return o.cause == loop.cause; });
    map.loops.push_back(loop);
    map.loops.back().closed_at = map.number;
    map.loops.back().num_landmarks_then = map.landmarks.size();
  }
}

void rescale_around(MapVersion& map, const std::vector<PoseChange>& changes) {
  if (std::all_of(changes.begin(), changes.end(),
                  [](const PoseChange& change) { return change.scale == 1.0; }))
    return;
  std::vector<double> factors(map.keyframes.size(), 1.0);
  for (const auto& change : changes) factors[change.keyframe.index()] = change.scale;
  rescale(map, std::move(factors));
}

void move(MapVersion& map, const Edit& edit) {
  rescale_around(map, edit.pose_changes);
  for (const auto& change : edit.pose_changes) {
    Keyframe& keyframe = map.keyframes.edit(change.keyframe.index());
    core::require(is_live(keyframe), "a culled keyframe moves with its parent");
    keyframe.world_from_body = change.new_from_old * keyframe.world_from_body;
    keyframe.world_from_body.rotation.normalize();
  }
  for (const auto& refinement : edit.refinements) {
    Keyframe& keyframe = map.keyframes.edit(refinement.keyframe.index());
    keyframe.refined_parent_from_keyframe = refinement.parent_from_keyframe;
    keyframe.refined_at = map.number;
  }
  for (const auto& settlement : edit.settled) {
    Keyframe& keyframe = map.keyframes.edit(settlement.keyframe.index());
    keyframe.settled_parent_from_keyframe = settlement.parent_from_keyframe;
    keyframe.settled_at = map.number;
  }
  for (const auto& change : edit.landmark_changes)
    map.landmarks.edit(change.landmark.index()).position_in_anchor = change.position_in_anchor;
}

}  // namespace

MapVersion apply(MapVersion map, const Edit& edit) {
  withdraw(map, edit.withdrawn_loops, edit.unmerged_landmarks);
  for (const auto& keyframe : edit.keyframes) {
    core::require(keyframe.id.index() == map.keyframes.size(),
                  "keyframes are added in the order of their ids");
    map.keyframes.push_back(keyframe);
  }
  for (const auto& landmark : edit.landmarks) {
    core::require(landmark.id.index() == map.landmarks.size(),
                  "landmarks are added in the order of their ids");
    map.landmarks.push_back(landmark);
  }
  for (const auto& sighting : edit.sightings) add_observation(map, sighting);
  add_loops(map, edit);
  move(map, edit);
  for (const auto& removed : edit.removed_observations) remove_observation(map, removed);
  for (const auto& made : edit.merges) merge(map, made);
  for (const auto& id : edit.culled_landmarks) cull(map, id);
  for (const auto& id : edit.culled_keyframes) cull(map, id);
  ++map.number;
  return map;
}

double weight_of_depth(double depth_m) { return 1.0 / std::pow(depth_m, 4.0); }

Eigen::Vector3d position_in_world(const MapVersion& map, const Landmark& landmark) {
  return world_from_body(map, landmark.anchor) * landmark.position_in_anchor;
}

core::Rigid3 parent_from_keyframe(const Keyframe& keyframe) {
  core::require(keyframe.odometry.has_value(), "the first keyframe of a session has no parent");
  return keyframe.refined_parent_from_keyframe.value_or(keyframe.odometry->parent_from_keyframe);
}

core::Rigid3 settled_parent_from_keyframe(const Keyframe& keyframe) {
  const bool is_youngest =
      keyframe.settled_parent_from_keyframe &&
      (!keyframe.refined_parent_from_keyframe || keyframe.settled_at >= keyframe.refined_at);
  return is_youngest ? *keyframe.settled_parent_from_keyframe : parent_from_keyframe(keyframe);
}

Holder holder_of(const MapVersion& map, core::KeyframeId id) {
  Holder holder{id, {}};
  while (!is_live(map.at(holder.keyframe))) {
    const Keyframe& culled = map.at(holder.keyframe);
    holder = {culled.odometry->parent,
              *culled.culled_parent_from_keyframe * holder.holder_from_keyframe};
  }
  return holder;
}

const Keyframe* keyframe_of(const MapVersion& map, core::FrameId frame) {
  for (std::size_t i = 0; i < map.keyframes.size(); ++i)
    if (map.keyframes[i].view.frame == frame) return &map.keyframes[i];
  return nullptr;
}

core::Rigid3 world_from_body(const MapVersion& map, core::KeyframeId id) {
  const Keyframe& keyframe = map.at(id);
  if (is_live(keyframe)) return keyframe.world_from_body;
  const Holder holder = holder_of(map, id);
  return map.at(holder.keyframe).world_from_body * holder.holder_from_keyframe;
}

core::Rigid3 reference_from_frame(const MapVersion& map, const core::FramePose& pose) {
  core::Rigid3 reference_from_frame = pose.reference_from_frame;
  const double log_factor = map.at(pose.reference_keyframe).log_scale - pose.log_scale;
  if (log_factor != 0.0) reference_from_frame.translation *= std::exp(log_factor);
  return reference_from_frame;
}

core::Rigid3 world_from_frame(const MapVersion& map, const core::FramePose& pose) {
  return world_from_body(map, pose.reference_keyframe) * reference_from_frame(map, pose);
}

bool is_without_depth(const MapVersion& map) {
  core::require(!map.keyframes.empty(), "the first keyframe says whether its camera has depth");
  const features::View& first = map.keyframes[0].view;
  return first.features && !has_depth(first);  // without features: a graph of poses alone
}

bool has_scale_drift(const MapVersion& map) {
  return is_without_depth(map) && !map.has_metric_odometry;
}

const Landmark& survivor_of(const MapVersion& map, core::LandmarkId id) {
  while (map.at(id).merged_into.is_valid()) id = map.at(id).merged_into;
  return map.at(id);
}

std::vector<Covisible> covisible_keyframes(const MapVersion& map, core::KeyframeId id) {
  std::map<core::KeyframeId, int> shared;
  for (const core::LandmarkId landmark : map.at(id).slots) {
    if (!landmark.is_valid()) continue;
    for (const auto& observation : map.at(landmark).observations) ++shared[observation.keyframe];
  }
  shared.erase(id);
  std::vector<Covisible> ranked;
  for (const auto& [keyframe, count] : shared) ranked.push_back({keyframe, count});
  std::sort(ranked.begin(), ranked.end(), [](const Covisible& a, const Covisible& b) {
    return std::pair(a.num_shared, a.keyframe) > std::pair(b.num_shared, b.keyframe);
  });
  return ranked;
}

std::vector<core::Rigid3> odometry_poses(const MapVersion& map) {
  std::vector<core::Rigid3> world_from_body;
  for (std::size_t i = 0; i < map.keyframes.size(); ++i) {
    const Keyframe& keyframe = map.keyframes[i];
    if (!keyframe.odometry) {
      world_from_body.push_back(keyframe.world_from_body);
      continue;
    }
    core::Rigid3 edge = parent_from_keyframe(keyframe);
    edge.translation *= std::exp(-map.at(keyframe.odometry->parent).log_scale);
    world_from_body.push_back(world_from_body[keyframe.odometry->parent.index()] * edge);
  }
  return world_from_body;
}

}  // namespace samewhere::scene
