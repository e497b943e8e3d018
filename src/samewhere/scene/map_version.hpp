#pragma once

#include <array>
#include <cstdint>
#include <memory_resource>
#include <optional>
#include <vector>

#include <samewhere/core/frame_pose.hpp>
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
  core::CandidateId cause =
      {};  // the loop for which it was made; invalid: tracking or mapping alone
};

// A 3D point with its descriptor. Its position is relative to the anchor, a keyframe that observes
// it, or observed it and is live.
struct Landmark {
  core::LandmarkId id;
  core::KeyframeId anchor;
  Eigen::Vector3d position_in_anchor = Eigen::Vector3d::Zero();  // body frame of the anchor, metres
  Eigen::Vector3d normal_in_anchor =
      Eigen::Vector3d::UnitZ();  // unit vector from the point to the last camera that observed it
  double range_m = 0.0;          // distance at which its descriptor was computed
  int octave = 0;                // pyramid level at that distance
  double weight = 0.0;           // sum of the inverse variances of its depths
  OrbDescriptor descriptor{};    // as seen last
  std::array<std::uint8_t, 3> rgb{};
  std::pmr::vector<Observation> observations;  // one per keyframe at most
  core::LandmarkId merged_into;                // valid: the same point as that one, see Merge
  bool is_culled = false;                      // removed; only its id remains
};

// Whether the landmark is part of the map.
inline bool is_live(const Landmark& landmark) {
  return !landmark.is_culled && !landmark.merged_into.is_valid();
}

// What odometry measured between a keyframe and the one it was tracked from.
struct OdometryEdge {
  core::KeyframeId parent;
  core::Rigid3 parent_from_keyframe;
  core::Matrix6d information = core::Matrix6d::Identity();
};

struct Keyframe {
  core::KeyframeId id;
  core::Rigid3 world_from_body;          // of a culled one: ask world_from_body(map, id)
  std::optional<OdometryEdge> odometry;  // none: the first of its session
  features::View view;                   // immutable picture of the past
  std::vector<core::LandmarkId> slots;   // one per feature; invalid = shows no landmark
  // Pose relative to its odometry parent by a local bundle adjustment of both: more accurate than
  // odometry, and as independent of loops.
  std::optional<core::Rigid3> refined_parent_from_keyframe;
  std::uint64_t refined_at = 0;  // MapVersion::number then
  // The same by full bundle adjustment, which depends on the loops of its time.
  std::optional<core::Rigid3> settled_parent_from_keyframe;
  std::uint64_t settled_at = 0;  // MapVersion::number then
  // Set: culled. It observes no landmark; its pose is relative to its odometry parent.
  std::optional<core::Rigid3> culled_parent_from_keyframe;
  // Logarithm of the scale correction of lengths around it since its odometry was measured: see
  // rescale.hpp.
  double log_scale = 0.0;
};

inline bool is_live(const Keyframe& keyframe) { return !keyframe.culled_parent_from_keyframe; }

// How large the error of odometry was that a loop took out: under the covariance of the drift since
// the match and that of the loop, chi-square with 6 degrees of freedom; and the standard deviation
// of the position under that drift, in its least certain direction, metres.
struct DriftSample {
  double chi_square = 0.0;
  double sigma_m = 0.0;
};

// An accepted loop between two keyframes.
struct LoopEdge {
  core::KeyframeId query;
  core::KeyframeId match;
  core::Rigid3 match_from_query;
  core::Matrix6d information = core::Matrix6d::Identity();
  core::CandidateId cause;
  double log_scale = 0.0;       // what is 1 long at the query is exp(log_scale) long at the match
  std::uint64_t closed_at = 0;  // MapVersion::number then; set by apply()
  std::uint64_t num_landmarks_then = 0;  // landmarks of the map then, all; set by apply()
  // None: it told nothing new, or its map was loaded from a file.
  std::optional<DriftSample> drift_sample;
};

// Number of keyframes or landmarks that are part of the map.
template <class Row>
std::size_t num_live(const ChunkedVector<Row>& rows) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) count += is_live(rows[i]) ? 1 : 0;
  return count;
}

// Two landmarks are one point. `from` keeps its row and its observations, so that the merge can be
// undone by its cause; the map shows `to` in place of both.
struct Merge {
  core::LandmarkId from;
  core::LandmarkId to;
  core::CandidateId cause;    // the loop that brought them together; invalid: mapping alone
  std::uint64_t made_at = 0;  // MapVersion::number then; set by apply()
};

// The map at one moment. Ids are positions: keyframe k is keyframes[k].
struct MapVersion {
  std::uint64_t number = 0;  // how many edits made it
  ChunkedVector<Keyframe> keyframes;
  ChunkedVector<Landmark> landmarks;
  std::vector<LoopEdge> loops;
  // Accepted by the loop verifier and rejected by the robust pose graph. Not part of the graph;
  // re-tested whenever a loop is added. Their keyframes may be culled.
  std::vector<LoopEdge> suspended_loops;
  ChunkedVector<Merge> merges;  // in the order they were made, without undone ones
  // Lengths are metric without depth: the poses are those of odometry from a file. Not stored.
  bool has_metric_odometry = false;

  const Keyframe& at(core::KeyframeId id) const { return keyframes[id.index()]; }
  const Landmark& at(core::LandmarkId id) const { return landmarks[id.index()]; }
};

// A new observation of a known landmark.
struct Sighting {
  core::LandmarkId landmark;
  Observation observation;
};

// Correction of a keyframe's pose: world_from_body becomes new_from_old * world_from_body, and
// lengths measured from there are multiplied by `scale`.
struct PoseChange {
  core::KeyframeId keyframe;
  core::Rigid3 new_from_old;
  double scale = 1.0;
};

// Pose of a keyframe relative to its odometry parent by bundle adjustment.
struct Refinement {
  core::KeyframeId keyframe;
  core::Rigid3 parent_from_keyframe;
};

// New position of a landmark.
struct LandmarkChange {
  core::LandmarkId landmark;
  Eigen::Vector3d position_in_anchor = Eigen::Vector3d::Zero();
};

// An outlier observation: the feature shows no landmark any more.
struct RemovedObservation {
  core::LandmarkId landmark;
  core::KeyframeId keyframe;
};

// A change of the map, as a value: what is added, what moves and what goes. Applied in the order of
// the fields.
struct Edit {
  std::vector<core::CandidateId> withdrawn_loops;    // removed with all that they caused
  std::vector<core::LandmarkId> unmerged_landmarks;  // their merges are undone
  std::vector<Keyframe> keyframes;
  std::vector<Landmark> landmarks;
  std::vector<Sighting> sightings;
  std::vector<PoseChange> pose_changes;
  std::vector<Refinement> refinements;
  std::vector<Refinement> settled;  // by full bundle adjustment: dependent on loops
  std::vector<LandmarkChange> landmark_changes;
  std::vector<RemovedObservation> removed_observations;
  std::vector<Merge> merges;
  std::vector<core::LandmarkId> culled_landmarks;
  std::vector<core::KeyframeId> culled_keyframes;
  std::vector<LoopEdge> suspended_loops;
  std::vector<LoopEdge> loops;  // accepted; if suspended before, no longer
};

// The version after the edit. Ids are positions and stay: what is merged or culled is marked, not
// removed; withdraw.hpp has the effects of withdrawn loops. Throws ContractError if ids do not
// continue the map's or are not in the map, for a culled keyframe without odometry parent and for
// one with a loop edge.
MapVersion apply(MapVersion map, const Edit& edit);

// Weight of a depth in a landmark's mean: the variance of a triangulated depth grows with its
// fourth power; the factor cancels.
double weight_of_depth(double depth_m);

Eigen::Vector3d position_in_world(const MapVersion& map, const Landmark& landmark);

// Pose of a keyframe relative to its odometry parent, independent of loops: by local bundle
// adjustment if there was one, else by odometry. ContractError without a parent.
core::Rigid3 parent_from_keyframe(const Keyframe& keyframe);
// The same with loops: by full bundle adjustment, unless a local one is younger.
core::Rigid3 settled_parent_from_keyframe(const Keyframe& keyframe);

// Pose of a keyframe, culled or not.
core::Rigid3 world_from_body(const MapVersion& map, core::KeyframeId id);

// The keyframe, live or not, that the frame became; nullptr: it is none.
const Keyframe* keyframe_of(const MapVersion& map, core::FrameId frame);

// Pose of a frame relative to its reference keyframe, in the map's current scale.
core::Rigid3 reference_from_frame(const MapVersion& map, const core::FramePose& pose);
// In the world, if the pose was measured.
core::Rigid3 world_from_frame(const MapVersion& map, const core::FramePose& pose);

// Whether depths come from motion: the first keyframe has no depth measurements.
bool is_without_depth(const MapVersion& map);
// Whether lengths come from visual motion alone and have scale drift.
bool has_scale_drift(const MapVersion& map);

// The keyframe that holds a pose: itself, or the first of its odometry ancestors that is not
// culled.
struct Holder {
  core::KeyframeId keyframe;
  core::Rigid3 holder_from_keyframe;
};

Holder holder_of(const MapVersion& map, core::KeyframeId id);

// The landmark that is shown in place of this one: itself unless it was merged. It may be culled.
const Landmark& survivor_of(const MapVersion& map, core::LandmarkId id);

// Whether the shortest path between two live keyframes, in number of odometry and loop edges, uses
// a loop: their relative pose depends on that loop then, and is not odometry.
bool shortest_path_uses_loop(const MapVersion& map, core::KeyframeId a, core::KeyframeId b);

// A keyframe and the number of landmarks it shares with another.
struct Covisible {
  core::KeyframeId keyframe;
  int num_shared = 0;
};

// The keyframes that share landmarks with this one, most first; ties go to the younger.
std::vector<Covisible> covisible_keyframes(const MapVersion& map, core::KeyframeId id);

// Pose of every keyframe, culled ones too, by odometry alone, independent of loops: the edges
// composed from the first keyframe on.
std::vector<core::Rigid3> odometry_poses(const MapVersion& map);

}  // namespace samewhere::scene
