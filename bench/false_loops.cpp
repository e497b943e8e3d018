#include "false_loops.hpp"

#include <algorithm>
#include <utility>

#include <samewhere/core/errors.hpp>
#include <samewhere/evaluate/trajectory_error.hpp>
#include <samewhere/verify/measure_odometry.hpp>

namespace samewhere::bench {
namespace {

constexpr double kMinError_m = 0.5;
constexpr double kMaxError_m = 6.0;  // a larger one is rejected by the pose graph, too
constexpr std::uint64_t kTrueLoopsAfter[] = {6, 8, 10, 12};  // keyframes after the false loop
constexpr std::uint64_t kTrueCause = 1'000'000;              // above the ids of all candidates

// Removes the loops of the loop verifier, whose odometry gate would keep false ones out. The
// question, if it is one for loops; else null.
const pipeline::FindLoops* without_accepted_loops(const pipeline::ToLoopClosing& question,
                                                  pipeline::LoopAnswer& answer) {
  const auto* asked = std::get_if<pipeline::FindLoops>(&question);
  answer.loops.clear();
  return asked;
}

}  // namespace

core::Rigid3 true_pose(const core::Truth& truth, const scene::MapVersion& map,
                       core::KeyframeId id) {
  const features::View& view = map.at(id).view;
  const auto world_from_camera = evaluate::truth_at(truth.trajectory, view.stamp_s);
  core::require(world_from_camera.has_value(), "a twin building has the true pose of every frame");
  return *world_from_camera * inverse(view.rig->body_from_camera[0]);
}

FalseLoopInjector::FalseLoopInjector(const pipeline::Config& config, int inject_after,
                                     core::Truth truth)
    : config_(config), inject_after_(inject_after), truth_(std::move(truth)) {}

void FalseLoopInjector::answer(const pipeline::ToLoopClosing& question,
                               pipeline::LoopAnswer& answer) {
  if (false_loop_) return answer_with_true_loops(question, answer);
  const auto* asked = without_accepted_loops(question, answer);
  if (asked != nullptr && asked->keyframe.index() >= static_cast<std::uint64_t>(inject_after_))
    inject(*asked, answer);
}

void FalseLoopInjector::answer_with_true_loops(const pipeline::ToLoopClosing& question,
                                               pipeline::LoopAnswer& answer) const {
  const auto* asked = without_accepted_loops(question, answer);
  if (asked == nullptr) return;
  if (const auto loop = true_loop_for(asked->map, asked->keyframe)) answer.loops.push_back({*loop});
}

core::Rigid3 FalseLoopInjector::true_match_from_query(const scene::MapVersion& map,
                                                      core::KeyframeId match,
                                                      core::KeyframeId query) const {
  return inverse(true_pose(truth_, map, match)) * true_pose(truth_, map, query);
}

void FalseLoopInjector::inject(const pipeline::FindLoops& question, pipeline::LoopAnswer& answer) {
  for (auto& row : answer.rows) {
    const auto* rejected = std::get_if<core::Rejection>(&row.verdict);
    if (rejected == nullptr || rejected->stage != core::Refusal::kOdometry) continue;
    const core::KeyframeId match = scene::keyframe_of(question.map, row.candidate.match)->id;
    const auto estimated = rejected->evidence.geometry->match_from_query;
    const core::Rigid3 truth = true_match_from_query(question.map, match, question.keyframe);
    const double error_m = (rigid_part(*estimated).translation - truth.translation).norm();
    if (error_m < kMinError_m || error_m > kMaxError_m) continue;
    const core::Matrix6d information = verify::loop_information(config_.verify);
    false_loop_ =
        FalseLoop{{question.keyframe, match, rigid_part(*estimated), information, row.candidate.id},
                  error_m,
                  question.keyframe.index(),
                  question.map};
    row.verdict = core::LoopClosure{.candidate = row.candidate.id,
                                    .evidence = rejected->evidence,
                                    .match_from_query = estimated,
                                    .information = information};
    answer.loops.push_back({false_loop_->loop});
    return;
  }
}

std::optional<scene::LoopEdge> FalseLoopInjector::true_loop_for(const scene::MapVersion& map,
                                                                core::KeyframeId query) const {
  if (!false_loop_ || query.index() < false_loop_->query) return std::nullopt;
  const std::uint64_t since = query.index() - false_loop_->query;
  if (std::find(std::begin(kTrueLoopsAfter), std::end(kTrueLoopsAfter), since) ==
      std::end(kTrueLoopsAfter))
    return std::nullopt;
  const core::KeyframeId match = holder_of(map, false_loop_->loop.match).keyframe;
  return scene::LoopEdge{query, match, true_match_from_query(map, match, query),
                         verify::loop_information(config_.verify),
                         core::CandidateId(kTrueCause + since)};
}

std::size_t FalseLoopInjector::last_true_loop_at(const scene::MapVersion& map) const {
  const std::uint64_t last = false_loop_->query + *std::rbegin(kTrueLoopsAfter);
  return std::min<std::size_t>(last, map.keyframes.size() - 1);
}

std::set<core::CandidateId> FalseLoopInjector::true_causes() {
  std::set<core::CandidateId> causes;
  for (const std::uint64_t since : kTrueLoopsAfter) causes.emplace(kTrueCause + since);
  return causes;
}

}  // namespace samewhere::bench
