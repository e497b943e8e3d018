#pragma once

#include <optional>

#include <samewhere/core/ledger.hpp>
#include <samewhere/features/features.hpp>

namespace samewhere::verify {

// Query and match of a candidate.
struct CandidateViews {
  features::View query;
  features::View match;
};

// The map's part in the verification of the candidates of one query. Two implementations:
// WithoutMap below, and pipeline::MapVersionContext. Frames are those of views that were
// remembered.
class MapContext {
 public:
  MapContext() = default;
  MapContext(const MapContext&) = delete;
  MapContext& operator=(const MapContext&) = delete;
  virtual ~MapContext() = default;

  // Whether common landmarks connect the match with the query already: then a loop between them is
  // redundant.
  virtual bool is_connected(core::FrameId match) const = 0;
  // Whether the map knows which views show one place, and whether these two do.
  virtual bool has_places() const = 0;
  virtual bool are_one_place(core::FrameId a, core::FrameId b) const = 0;

  // Of a camera without depth: both views with the depths of their landmarks, each in its own
  // scale. Nothing where the depths of the features are metric.
  virtual std::optional<CandidateViews> views_with_landmark_depths(
      const core::Candidate& candidate) const = 0;

  // The causes of the loops that the map has, in the order of closing. Empty without a map.
  virtual std::vector<core::CandidateId> loops() const = 0;

  // How much the pose graph bends if the candidate is added. Nothing without a map.
  virtual std::optional<core::DeformationEvidence> measure_deformation(
      const core::Candidate& candidate, const core::Sim3& match_from_query) const = 0;

  // Odometry gate and competing hypothesis of an earlier loop for the candidate's measured pose.
  // Nothing without odometry, or without an earlier loop.
  virtual std::optional<core::OdometryEvidence> measure_odometry(
      const core::Candidate& candidate, const core::Sim3& match_from_query) const = 0;
  virtual std::optional<core::CompetingLoopEvidence> measure_competing_loop(
      const core::Candidate& candidate, const core::Sim3& match_from_query) const = 0;

  // Another candidate of the same query as competing hypothesis, without its inliers. Nothing
  // unless the map knows that both show different places.
  virtual std::optional<core::CompetingPlaceEvidence> measure_competing_place(
      const core::LedgerRow& row, const core::LedgerRow& other) const = 0;
};

// Recognition alone, and relocalization: no odometry, no places, no landmarks.
class WithoutMap : public MapContext {
 public:
  bool is_connected(core::FrameId /*match*/) const override { return false; }
  bool has_places() const override { return false; }
  bool are_one_place(core::FrameId a, core::FrameId b) const override { return a == b; }
  std::optional<CandidateViews> views_with_landmark_depths(
      const core::Candidate& /*candidate*/) const override {
    return std::nullopt;
  }
  std::vector<core::CandidateId> loops() const override { return {}; }
  std::optional<core::DeformationEvidence> measure_deformation(
      const core::Candidate& /*candidate*/, const core::Sim3& /*match_from_query*/) const override {
    return std::nullopt;
  }
  std::optional<core::OdometryEvidence> measure_odometry(
      const core::Candidate& /*candidate*/, const core::Sim3& /*match_from_query*/) const override {
    return std::nullopt;
  }
  std::optional<core::CompetingLoopEvidence> measure_competing_loop(
      const core::Candidate& /*candidate*/, const core::Sim3& /*match_from_query*/) const override {
    return std::nullopt;
  }
  std::optional<core::CompetingPlaceEvidence> measure_competing_place(
      const core::LedgerRow& /*row*/, const core::LedgerRow& /*other*/) const override {
    return std::nullopt;
  }
};

}  // namespace samewhere::verify
