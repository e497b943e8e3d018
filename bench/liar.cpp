#include "liar.hpp"

#include <algorithm>
#include <map>

#include <samewhere/core/errors.hpp>
#include <samewhere/evaluate/trajectory_error.hpp>
#include <samewhere/verify/measure_odometry.hpp>

namespace samewhere::bench {
namespace {

constexpr double kMinError_m = 0.5;
constexpr double kMaxError_m = 6.0;  // beyond, the pose graph does not believe it either
constexpr double kSamePoint_m = 0.3;
constexpr std::uint64_t kTruthAfter[] = {6, 8, 10, 12};  // keyframes after the lie
constexpr std::uint64_t kTruthCause = 1'000'000;         // beyond those of the judge

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

}  // namespace

Liar::Liar(const pipeline::Config& config, int lie_after)
    : config_(config), lie_after_(lie_after) {}

Liar::Liar(const pipeline::Config& config, const Lie& untold)
    : config_(config), is_honest_(true), lie_(untold) {}

void Liar::answer(const pipeline::ToLoopClosing& question, pipeline::LoopAnswer& answer) {
  const auto* asked = std::get_if<pipeline::FindLoops>(&question);
  if (asked == nullptr) return;
  // who believes a lie has the judge, which asks odometry, believe others
  answer.loops.clear();
  if (lie_) {
    tell_truth(*asked, answer);
  } else if (asked->keyframe.index() >= static_cast<std::uint64_t>(lie_after_)) {
    tell_lie(*asked, answer);
  }
}

core::Rigid3 Liar::true_pose(const scene::MapVersion& map, core::KeyframeId id) const {
  const features::View& view = map.at(id).view;
  const auto world_from_camera = evaluate::truth_at(truth_.trajectory, view.stamp_s);
  core::require(world_from_camera.has_value(), "a made-up building knows every pose");
  return *world_from_camera * inverse(view.rig->body_from_camera[0]);
}

core::Rigid3 Liar::true_match_from_query(const scene::MapVersion& map, core::KeyframeId match,
                                         core::KeyframeId query) const {
  return inverse(true_pose(map, match)) * true_pose(map, query);
}

void Liar::tell_lie(const pipeline::FindLoops& question, pipeline::LoopAnswer& answer) {
  for (auto& row : answer.rows) {
    const auto* refused = std::get_if<core::Rejection>(&row.verdict);
    if (refused == nullptr || refused->stage != core::Refusal::kOdometry) continue;
    const core::KeyframeId match = scene::keyframe_of(question.map, row.candidate.match)->id;
    const auto found = refused->evidence.geometry->match_from_query;
    const core::Rigid3 truth = true_match_from_query(question.map, match, question.keyframe);
    const double error_m = (rigid_part(*found).translation - truth.translation).norm();
    if (error_m < kMinError_m || error_m > kMaxError_m) continue;
    const core::Matrix6d information = verify::loop_information(config_.verify);
    lie_ = Lie{{question.keyframe, match, rigid_part(*found), information, row.candidate.id},
               error_m,
               question.keyframe.index()};
    row.verdict = core::LoopClosure{.candidate = row.candidate.id,
                                    .evidence = refused->evidence,
                                    .match_from_query = found,
                                    .information = information,
                                    .pairs = {}};
    answer.loops.push_back({lie_->loop});
    before_ = question.map;
    return;
  }
}

void Liar::tell_truth(const pipeline::FindLoops& question, pipeline::LoopAnswer& answer) const {
  const std::uint64_t since = question.keyframe.index() - lie_->asked_at;
  if (std::find(std::begin(kTruthAfter), std::end(kTruthAfter), since) == std::end(kTruthAfter))
    return;
  const core::KeyframeId match = holder_of(question.map, lie_->loop.match).keyframe;
  answer.loops.push_back(
      {{question.keyframe, match, true_match_from_query(question.map, match, question.keyframe),
        verify::loop_information(config_.verify), core::CandidateId(kTruthCause + since)}});
}

void Liar::see(const scene::MapVersion& map) {
  if (is_honest_ || !lie_) return;
  if (has_loop(map, lie_->loop.cause)) {
    believed_ = map;
  } else if (!believed_.keyframes.empty() && !aftermath_.withdrawn_at) {
    compare(map);
  }
}

void Liar::compare(const scene::MapVersion& map) {
  const core::CandidateId cause = lie_->loop.cause;
  aftermath_.withdrawn_at = map.keyframes.back().id.index();
  for (std::size_t i = 0; i < believed_.merges.size(); ++i)
    aftermath_.num_merged += believed_.merges[i].cause == cause;
  for (std::size_t i = 0; i < believed_.landmarks.size(); ++i)
    for (const auto& o : believed_.landmarks[i].observations)
      aftermath_.num_seen += is_live(believed_.landmarks[i]) && o.cause == cause;
  const auto error =
      evaluate::ate(truth_.trajectory, keyframe_trajectory(believed_), evaluate::Alignment::kSe3);
  if (error) aftermath_.ate_believed_m = error->rmse_m;

  const auto in_truth = [&](core::LandmarkId id) {
    const scene::Landmark& landmark = before_.at(id);
    return true_pose(before_, landmark.anchor) * landmark.position_in_anchor;
  };
  const std::size_t num_before = before_.landmarks.size();
  for (std::size_t i = 0; i < num_before; ++i) {
    const core::LandmarkId id(i);
    const scene::Landmark& was = survivor_of(before_, id);
    const scene::Landmark& is = survivor_of(map, id);
    const auto& observations = map.at(id).observations;
    const bool is_marked = std::any_of(observations.begin(), observations.end(),
                                       [&](const auto& o) { return o.cause == cause; });
    // still one with who stood for it
    const bool is_apart = survivor_of(map, was.id).id != is.id;
    aftermath_.num_not_restored += is_marked || is_apart;
    if (was.id != id || is.id == id || is.id.index() >= num_before) continue;
    ++aftermath_.num_later_merges;
    aftermath_.num_wrong_merges += (in_truth(id) - in_truth(is.id)).norm() > kSamePoint_m;
  }
}

}  // namespace samewhere::bench
