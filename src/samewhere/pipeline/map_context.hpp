#pragma once

#include <map>
#include <optional>
#include <set>

#include <samewhere/core/ledger.hpp>
#include <samewhere/pipeline/config.hpp>
#include <samewhere/scene/map_version.hpp>
#include <samewhere/verify/map_context.hpp>
#include <samewhere/verify/map_drift.hpp>

namespace samewhere::pipeline {

// The keyframe of each remembered frame.
using KeyframeOf = std::map<core::FrameId, core::KeyframeId>;

verify::ScaleErrors scale_errors(const Config& config);
verify::OdometryTree odometry_tree(const Config& config);

// A map version in the verification of one query. Not copyable: refers to its arguments, which
// outlive it.
class MapVersionContext final : public verify::MapContext {
 public:
  // `odometry` follows the map from here on.
  MapVersionContext(const scene::MapVersion& map, verify::OdometryTree& odometry,
                    const KeyframeOf& keyframe_of, core::FrameId query, const Config& config);

  bool is_connected(core::FrameId match) const override;
  bool has_places() const override { return true; }
  // Keyframes with at least map.min_shared common landmarks show one place.
  bool are_one_place(core::FrameId a, core::FrameId b) const override;

  std::optional<verify::CandidateViews> views_with_landmark_depths(
      const core::Candidate& candidate) const override;
  std::vector<core::CandidateId> loops() const override;
  std::optional<core::DeformationEvidence> measure_deformation(
      const core::Candidate& candidate, const core::Sim3& match_from_query) const override;
  std::optional<core::OdometryEvidence> measure_odometry(
      const core::Candidate& candidate, const core::Sim3& match_from_query) const override;
  std::optional<core::CompetingLoopEvidence> measure_competing_loop(
      const core::Candidate& candidate, const core::Sim3& match_from_query) const override;
  // Nothing for two candidates of one place, whatever odometry says.
  std::optional<core::CompetingPlaceEvidence> measure_competing_place(
      const core::LedgerRow& row, const core::LedgerRow& other) const override;

  // What the loop tells of odometry.
  std::optional<scene::DriftSample> measure_drift(const scene::LoopEdge& loop) const;

  // The edge of the pose graph that the candidate's relative pose would be. Without depth between
  // the keyframes that hold culled ones, since a culled keyframe has no landmark depths.
  scene::LoopEdge edge_of(const core::Candidate& candidate,
                          const core::Sim3& match_from_query) const;

 private:
  core::KeyframeId end_of(core::FrameId frame) const;
  core::KeyframeId holder(core::FrameId frame) const;
  // Itself and the keyframes with enough common landmarks; computed once for a frame.
  const std::set<core::KeyframeId>& neighbours(core::FrameId frame) const;

  const scene::MapVersion& map_;
  const KeyframeOf& keyframe_of_;
  const Config& config_;
  core::FrameId query_;
  bool is_without_depth_;
  mutable std::map<core::FrameId, std::set<core::KeyframeId>> neighbours_;
  mutable verify::MapDrift drift_;
};

}  // namespace samewhere::pipeline
