#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <samewhere/core/ids.hpp>
#include <samewhere/core/rigid3.hpp>
#include <samewhere/features/features.hpp>
#include <samewhere/scene/chunked_vector.hpp>

namespace samewhere::scene {

using OrbDescriptor = std::array<std::uint8_t, 32>;

// Feature `slot` of a keyframe shows the landmark.
struct Observation {
  core::KeyframeId keyframe;
  int slot = 0;
};

// A point of the world. Where it is hangs on the keyframe that saw it first.
struct Landmark {
  core::LandmarkId id;
  core::KeyframeId anchor;
  Eigen::Vector3d position_in_anchor = Eigen::Vector3d::Zero();  // body frame of the anchor, metres
  Eigen::Vector3d normal_in_anchor =
      Eigen::Vector3d::UnitZ();  // unit vector from the point to who saw it last
  double range_m = 0.0;          // distance from which it was described
  int octave = 0;                // pyramid level at that distance
  double weight = 0.0;           // sum of the inverse variances of its depths
  OrbDescriptor descriptor{};    // as seen last
  std::array<std::uint8_t, 3> rgb{};
  std::vector<Observation> observations;  // in the order of their keyframes
};

// What odometry measured between a keyframe and the one it was tracked from.
struct OdometryEdge {
  core::KeyframeId parent;
  core::Rigid3 parent_from_keyframe;
  core::Matrix6d information = core::Matrix6d::Identity();
};

struct Keyframe {
  core::KeyframeId id;
  core::Rigid3 world_from_body;
  std::optional<OdometryEdge> odometry;  // none: the first of its session
  features::View view;                   // immutable picture of the past
  std::vector<core::LandmarkId> slots;   // one per feature; invalid = shows no landmark
};

// An accepted loop between two keyframes.
struct LoopEdge {
  core::KeyframeId query;
  core::KeyframeId match;
  core::Rigid3 match_from_query;
  core::Matrix6d information = core::Matrix6d::Identity();
  core::CandidateId cause;
};

// The map at one moment. Ids are positions: keyframe k is keyframes[k].
struct MapVersion {
  std::uint64_t number = 0;  // how many edits made it
  ChunkedVector<Keyframe> keyframes;
  ChunkedVector<Landmark> landmarks;
  std::vector<LoopEdge> loops;

  const Keyframe& at(core::KeyframeId id) const { return keyframes[id.index()]; }
  const Landmark& at(core::LandmarkId id) const { return landmarks[id.index()]; }
};

// A known landmark was seen again.
struct Sighting {
  core::LandmarkId landmark;
  Observation observation;
};

// The world moved under a keyframe: world_from_body becomes new_from_old * world_from_body.
struct PoseChange {
  core::KeyframeId keyframe;
  core::Rigid3 new_from_old;
};

// A change of the map, as a value: what is added and what moves.
struct Edit {
  std::vector<Keyframe> keyframes;
  std::vector<Landmark> landmarks;
  std::vector<Sighting> sightings;
  std::vector<PoseChange> pose_changes;
  std::vector<LoopEdge> loops;
};

// The version after the edit. Throws ContractError if ids do not continue the map's or name what is
// not there.
MapVersion apply(MapVersion map, const Edit& edit);

// Weight of a depth in a landmark's mean: the variance of a triangulated depth grows with its
// fourth power; the factor cancels.
double weight_of_depth(double depth_m);

Eigen::Vector3d position_in_world(const MapVersion& map, const Landmark& landmark);

// Pose of every keyframe by odometry alone, as if no loop had ever been closed: the edges composed
// from the first on.
std::vector<core::Rigid3> odometry_poses(const MapVersion& map);

}  // namespace samewhere::scene
