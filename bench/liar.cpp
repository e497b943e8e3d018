#include "liar.hpp"

#include <algorithm>
#include <utility>

#include <samewhere/core/errors.hpp>
#include <samewhere/evaluate/trajectory_error.hpp>
#include <samewhere/verify/measure_odometry.hpp>

namespace samewhere::bench {
namespace {

constexpr double kMinError_m = 0.5;
constexpr double kMaxError_m = 6.0;  // beyond, the pose graph does not believe it either
constexpr std::uint64_t kTruthAfter[] = {6, 8, 10, 12};  // keyframes after the lie
constexpr std::uint64_t kTruthCause = 1'000'000;         // beyond those of the judge

// Who believes a lie has the judge, which asks odometry, believe others.
const pipeline::FindLoops* silenced(const pipeline::ToLoopClosing& question,
                                    pipeline::LoopAnswer& answer) {
  const auto* asked = std::get_if<pipeline::FindLoops>(&question);
  if (asked != nullptr) answer.loops.clear();
  return asked;
}

}  // namespace

core::Rigid3 true_pose(const core::Truth& truth, const scene::MapVersion& map,
                       core::KeyframeId id) {
  const features::View& view = map.at(id).view;
  const auto world_from_camera = evaluate::truth_at(truth.trajectory, view.stamp_s);
  core::require(world_from_camera.has_value(), "a made-up building knows every pose");
  return *world_from_camera * inverse(view.rig->body_from_camera[0]);
}

Liar::Liar(const pipeline::Config& config, int lie_after, core::Truth truth)
    : config_(config), lie_after_(lie_after), truth_(std::move(truth)) {}

void Liar::answer(const pipeline::ToLoopClosing& question, pipeline::LoopAnswer& answer) {
  if (lie_) return answer_honestly(question, answer);
  const auto* asked = silenced(question, answer);
  if (asked != nullptr && asked->keyframe.index() >= static_cast<std::uint64_t>(lie_after_))
    tell_lie(*asked, answer);
}

void Liar::answer_honestly(const pipeline::ToLoopClosing& question,
                           pipeline::LoopAnswer& answer) const {
  const auto* asked = silenced(question, answer);
  if (asked == nullptr) return;
  if (const auto loop = truth_for(asked->map, asked->keyframe)) answer.loops.push_back({*loop});
}

core::Rigid3 Liar::true_match_from_query(const scene::MapVersion& map, core::KeyframeId match,
                                         core::KeyframeId query) const {
  return inverse(true_pose(truth_, map, match)) * true_pose(truth_, map, query);
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
               question.keyframe.index(),
               question.map};
    row.verdict = core::LoopClosure{.candidate = row.candidate.id,
                                    .evidence = refused->evidence,
                                    .match_from_query = found,
                                    .information = information};
    answer.loops.push_back({lie_->loop});
    return;
  }
}

std::optional<scene::LoopEdge> Liar::truth_for(const scene::MapVersion& map,
                                               core::KeyframeId query) const {
  if (!lie_ || query.index() < lie_->asked_at) return std::nullopt;
  const std::uint64_t since = query.index() - lie_->asked_at;
  if (std::find(std::begin(kTruthAfter), std::end(kTruthAfter), since) == std::end(kTruthAfter))
    return std::nullopt;
  const core::KeyframeId match = holder_of(map, lie_->loop.match).keyframe;
  return scene::LoopEdge{query, match, true_match_from_query(map, match, query),
                         verify::loop_information(config_.verify),
                         core::CandidateId(kTruthCause + since)};
}

std::size_t Liar::last_truth_at(const scene::MapVersion& map) const {
  const std::uint64_t last = lie_->asked_at + *std::rbegin(kTruthAfter);
  return std::min<std::size_t>(last, map.keyframes.size() - 1);
}

std::set<core::CandidateId> Liar::true_causes() {
  std::set<core::CandidateId> causes;
  for (const std::uint64_t since : kTruthAfter) causes.emplace(kTruthCause + since);
  return causes;
}

}  // namespace samewhere::bench
