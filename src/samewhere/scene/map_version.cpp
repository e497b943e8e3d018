#include <cmath>
#include <cstring>

#include <samewhere/core/errors.hpp>
#include <samewhere/scene/map_version.hpp>

namespace samewhere::scene {
namespace {

// The new sighting becomes the landmark's looks; its depth, if it has one, is averaged into the
// position.
void see_again(MapVersion& map, const Sighting& sighting) {
  Landmark& landmark = map.landmarks.edit(sighting.landmark.index());
  const Keyframe& keyframe = map.at(sighting.observation.keyframe);
  const auto slot = static_cast<std::size_t>(sighting.observation.slot);
  core::require(slot < keyframe.slots.size(), "a sighting names a slot of its keyframe");
  const core::Rigid3 anchor_from_body =
      inverse(map.at(landmark.anchor).world_from_body) * keyframe.world_from_body;
  const core::Rigid3& body_from_camera = keyframe.view.rig->body_from_camera[0];

  if (const auto point = features::point_in_camera(keyframe.view, sighting.observation.slot)) {
    const double weight = weight_of_depth(point->z());
    const Eigen::Vector3d seen_at = anchor_from_body * (body_from_camera * *point);
    landmark.position_in_anchor =
        (landmark.weight * landmark.position_in_anchor + weight * seen_at) /
        (landmark.weight + weight);
    landmark.weight += weight;
  }
  const Eigen::Vector3d eye =
      (anchor_from_body * body_from_camera).translation - landmark.position_in_anchor;
  landmark.range_m = eye.norm();
  landmark.normal_in_anchor = eye.normalized();
  landmark.octave = keyframe.view.features->octave[slot];
  std::memcpy(landmark.descriptor.data(),
              keyframe.view.features->descriptors.ptr(sighting.observation.slot),
              landmark.descriptor.size());
  landmark.observations.push_back(sighting.observation);
  map.keyframes.edit(sighting.observation.keyframe.index()).slots[slot] = landmark.id;
}

}  // namespace

MapVersion apply(MapVersion map, const Edit& edit) {
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
  for (const auto& sighting : edit.sightings) see_again(map, sighting);
  for (const auto& change : edit.pose_changes) {
    Keyframe& keyframe = map.keyframes.edit(change.keyframe.index());
    keyframe.world_from_body = change.new_from_old * keyframe.world_from_body;
  }
  map.loops.insert(map.loops.end(), edit.loops.begin(), edit.loops.end());
  ++map.number;
  return map;
}

double weight_of_depth(double depth_m) { return 1.0 / std::pow(depth_m, 4.0); }

Eigen::Vector3d position_in_world(const MapVersion& map, const Landmark& landmark) {
  return map.at(landmark.anchor).world_from_body * landmark.position_in_anchor;
}

std::vector<core::Rigid3> odometry_poses(const MapVersion& map) {
  std::vector<core::Rigid3> world_from_body;
  for (std::size_t i = 0; i < map.keyframes.size(); ++i) {
    const Keyframe& keyframe = map.keyframes[i];
    world_from_body.push_back(keyframe.odometry
                                  ? world_from_body[keyframe.odometry->parent.index()] *
                                        keyframe.odometry->parent_from_keyframe
                                  : keyframe.world_from_body);
  }
  return world_from_body;
}

}  // namespace samewhere::scene
