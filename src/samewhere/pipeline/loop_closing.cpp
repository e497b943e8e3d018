#include <algorithm>
#include <utility>

#include <samewhere/core/match_from_query.hpp>
#include <samewhere/pipeline/loop_closing.hpp>
#include <samewhere/pipeline/verifier_settings.hpp>
#include <samewhere/report/jpeg.hpp>
#include <samewhere/verify/decide.hpp>
#include <samewhere/verify/measure_competing.hpp>
#include <samewhere/verify/measure_odometry.hpp>

namespace samewhere::pipeline {
namespace {

AcceptedLoop accepted_loop(const MapVersionContext& context, const scene::MapVersion& map,
                           const core::LedgerRow& row, const core::LoopClosure& loop) {
  scene::LoopEdge edge = context.edge_of(row.candidate, *loop.match_from_query);
  edge.drift_sample = context.measure_drift(edge);
  edge.information = loop.information;
  edge.cause = loop.candidate;
  return {.edge = edge,
          .overruled = loop.overruled,
          .query_log_scale = map.at(edge.query).log_scale,
          .match_log_scale = map.at(edge.match).log_scale};
}

std::vector<AcceptedLoop> accepted_loops(const MapVersionContext& context,
                                         const scene::MapVersion& map, const core::Ledger& rows) {
  std::vector<AcceptedLoop> loops;
  for (const core::LedgerRow& row : rows) {
    const auto* loop = std::get_if<core::LoopClosure>(&row.verdict);
    if (loop != nullptr && loop->match_from_query)
      loops.push_back(accepted_loop(context, map, row, *loop));
  }
  return loops;
}

// A keyframe of a map that was given up shows nothing of this one.
bool shows_landmarks(const scene::MapVersion& map, core::KeyframeId keyframe) {
  const auto& slots = map.at(holder_of(map, keyframe).keyframe).slots;
  return std::ranges::any_of(slots, [&](core::LandmarkId landmark) {
    return landmark.is_valid() && !survivor_of(map, landmark).is_culled;
  });
}

}  // namespace

core::Verdict reverify(const scene::MapVersion& map, verify::OdometryTree& odometry,
                       const scene::LoopEdge& loop, const core::LedgerRow& accepted,
                       const Config& config) {
  verify::MapDrift drift(map, odometry, scale_errors(config), config.verify);
  core::Evidence evidence = core::evidence_of(accepted.verdict);
  if (evidence.odometry) evidence.odometry = verify::measure_odometry(drift, loop);
  evidence.competing_loop = verify::measure_competing_loop(drift, loop);
  return verify::decide(accepted.candidate, evidence, {}, config.verify);
}

LoopClosing::LoopClosing(const Config& config)
    : config_(config), detector_(config, loop_settings(config)), odometry_(odometry_tree(config)) {}

LoopClosing::LoopClosing(const Config& config, const scene::StoredMap& known)
    : LoopClosing(config) {
  for (std::size_t i = 0; i < known.map.keyframes.size(); ++i)
    keyframe_of_[known.map.keyframes[i].view.frame] = known.map.keyframes[i].id;
  for (const auto& descriptor : known.extras.descriptors) {
    const auto keyframe = keyframe_of_.find(descriptor.frame);
    if (keyframe != keyframe_of_.end() && shows_landmarks(known.map, keyframe->second))
      detector_.remember(descriptor, known.map.at(keyframe->second).view);
  }
}

LoopAnswer LoopClosing::answer(const ToLoopClosing& message) {
  LoopAnswer answer =
      std::visit([this](const auto& question) { return this->answer(question); }, message);
  ledger_.insert(ledger_.end(), answer.rows.begin(), answer.rows.end());
  return answer;
}

LoopAnswer LoopClosing::answer(const FindLoops& question) {
  if (question.starts_map) detector_.forget();
  if (question.image.empty()) return {};
  const scene::MapVersion& map = question.map;
  const features::View& view = map.at(question.keyframe).view;
  keyframe_of_[view.frame] = question.keyframe;
  LoopAnswer answer{.map_number = map.number};
  {
    const core::ScopedTimer timer(timings_, "thumbnail");
    answer.thumbnail = {view.frame, report::jpeg_bytes(question.image, report::kThumbnailWidth_px)};
  }
  if (!config_.close_loops) {  // relocalization needs the view all the same
    answer.descriptor = detector_.index().describe(view.frame, question.image);
    detector_.remember(*answer.descriptor, view);
    return answer;
  }
  const MapVersionContext context(map, odometry_, keyframe_of_, view.frame, config_);
  answer.rows = detector_.detect(question.image, view, context, timings_);
  answer.loops = accepted_loops(context, map, answer.rows);
  const PlaceIndex& index = detector_.index();
  answer.descriptor = index.descriptor(index.num_descriptors() - 1);
  return answer;
}

LoopAnswer LoopClosing::answer(const FindPlace& question) {
  LoopAnswer answer;
  answer.rows = detector_.relocalize(question.image, question.view, timings_);
  for (const core::LedgerRow& row : answer.rows) {
    const auto& geometry = core::evidence_of(row.verdict).geometry;
    if (!geometry || geometry->num_inliers == 0) continue;
    Place place{.keyframe = keyframe_of_.at(row.candidate.match),
                .keyframe_from_body = std::nullopt,
                .is_recognised = verify::is_recognized(row.verdict)};
    if (geometry->match_from_query)
      place.keyframe_from_body = rigid_part(*geometry->match_from_query);
    answer.places.push_back(place);
  }
  return answer;
}

LoopAnswer LoopClosing::answer(const AskAgain& question) {
  const scene::MapVersion& map = question.map;
  const MapVersionContext context(map, odometry_, keyframe_of_, map.keyframes.back().view.frame,
                                  config_);
  LoopAnswer answer{.map_number = map.number};
  answer.rows = detector_.ask_again(context, timings_);
  answer.loops = accepted_loops(context, map, answer.rows);
  return answer;
}

}  // namespace samewhere::pipeline
