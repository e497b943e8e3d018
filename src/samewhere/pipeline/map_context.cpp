#include <cmath>

#include <samewhere/core/match_from_query.hpp>
#include <samewhere/correct/deformation.hpp>
#include <samewhere/pipeline/map_context.hpp>
#include <samewhere/pipeline/odometry_drift.hpp>
#include <samewhere/scene/known_depths.hpp>
#include <samewhere/verify/measure_competing.hpp>
#include <samewhere/verify/measure_odometry.hpp>

namespace samewhere::pipeline {

verify::ScaleErrors scale_errors(const Config& config) {
  return {.creep = config.optimize.odometry_scale_sigma, .loop = config.optimize.loop_scale_sigma};
}

verify::OdometryTree odometry_tree(const Config& config) {
  return verify::OdometryTree(systematic_drift(config.odometry));
}

MapVersionContext::MapVersionContext(const scene::MapVersion& map, verify::OdometryTree& odometry,
                                     const KeyframeOf& keyframe_of, core::FrameId query,
                                     const Config& config)
    : map_(map),
      keyframe_of_(keyframe_of),
      config_(config),
      query_(query),
      is_without_depth_(scene::is_without_depth(map)),
      drift_(map, odometry, scale_errors(config), config.verify) {}

bool MapVersionContext::is_connected(core::FrameId match) const {
  return are_one_place(query_, match);
}

bool MapVersionContext::are_one_place(core::FrameId a, core::FrameId b) const {
  return neighbours(a).contains(holder(b));
}

std::optional<verify::CandidateViews> MapVersionContext::views_with_landmark_depths(
    const core::Candidate& candidate) const {
  if (!is_without_depth_) return std::nullopt;
  return verify::CandidateViews{with_known_depths(map_, end_of(candidate.query)),
                                with_known_depths(map_, end_of(candidate.match))};
}

std::vector<core::CandidateId> MapVersionContext::loops() const {
  std::vector<core::CandidateId> causes;
  for (const scene::LoopEdge& loop : map_.loops) causes.push_back(loop.cause);
  return causes;
}

std::optional<core::DeformationEvidence> MapVersionContext::measure_deformation(
    const core::Candidate& candidate, const core::Sim3& match_from_query) const {
  scene::LoopEdge edge = edge_of(candidate, match_from_query);
  edge.information = verify::loop_information(config_.verify);
  return correct::measure_deformation(map_, edge, config_.optimize);
}

std::optional<core::OdometryEvidence> MapVersionContext::measure_odometry(
    const core::Candidate& candidate, const core::Sim3& match_from_query) const {
  return verify::measure_odometry(drift_, edge_of(candidate, match_from_query));
}

std::optional<scene::DriftSample> MapVersionContext::measure_drift(
    const scene::LoopEdge& loop) const {
  return verify::measure_drift(drift_, loop);
}

std::optional<core::CompetingLoopEvidence> MapVersionContext::measure_competing_loop(
    const core::Candidate& candidate, const core::Sim3& match_from_query) const {
  return verify::measure_competing_loop(drift_, edge_of(candidate, match_from_query));
}

std::optional<core::CompetingPlaceEvidence> MapVersionContext::measure_competing_place(
    const core::LedgerRow& row, const core::LedgerRow& other) const {
  const auto pose = core::match_from_query_of(row.verdict);
  const auto other_pose = core::match_from_query_of(other.verdict);
  if (!pose || !other_pose) return std::nullopt;
  if (are_one_place(row.candidate.match, other.candidate.match)) return std::nullopt;
  return verify::measure_competing_place(drift_, edge_of(row.candidate, *pose),
                                         edge_of(other.candidate, *other_pose));
}

scene::LoopEdge MapVersionContext::edge_of(const core::Candidate& candidate,
                                           const core::Sim3& match_from_query) const {
  scene::LoopEdge edge;
  edge.query = end_of(candidate.query);
  edge.match = end_of(candidate.match);
  edge.match_from_query = rigid_part(match_from_query);
  edge.log_scale = std::log(match_from_query.scale);
  return edge;
}

core::KeyframeId MapVersionContext::end_of(core::FrameId frame) const {
  return is_without_depth_ ? holder(frame) : keyframe_of_.at(frame);
}

core::KeyframeId MapVersionContext::holder(core::FrameId frame) const {
  return holder_of(map_, keyframe_of_.at(frame)).keyframe;
}

const std::set<core::KeyframeId>& MapVersionContext::neighbours(core::FrameId frame) const {
  const auto [found, is_new] = neighbours_.try_emplace(frame);
  if (!is_new) return found->second;
  const core::KeyframeId keyframe = holder(frame);
  found->second.insert(keyframe);
  for (const auto& covisible : covisible_keyframes(map_, keyframe))
    if (covisible.num_shared >= config_.map.min_shared) found->second.insert(covisible.keyframe);
  return found->second;
}

}  // namespace samewhere::pipeline
