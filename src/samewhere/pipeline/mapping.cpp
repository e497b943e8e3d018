#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <samewhere/correct/loop_corrector.hpp>
#include <samewhere/features/paged.hpp>
#include <samewhere/map/cull.hpp>
#include <samewhere/map/fuse.hpp>
#include <samewhere/map/local_bundle.hpp>
#include <samewhere/map/part.hpp>
#include <samewhere/map/triangulate.hpp>
#include <samewhere/pipeline/correction.hpp>
#include <samewhere/pipeline/loop_closing.hpp>
#include <samewhere/pipeline/mapping.hpp>

namespace samewhere::pipeline {
namespace {

// Another loop of the same view, say, may have stretched what lies at its ends since.
AcceptedLoop in_lengths_of_today(const scene::MapVersion& map, AcceptedLoop loop) {
  const double query = map.at(loop.edge.query).log_scale - loop.query_log_scale;
  const double match = map.at(loop.edge.match).log_scale - loop.match_log_scale;
  loop.edge.match_from_query.translation *= std::exp(match);
  loop.edge.log_scale += match - query;
  return loop;
}

}  // namespace

Mapping::Mapping(const Config& config, scene::MapVersion so_far, const Asks& asks, KeepMap keep_map)
    : config_(config),
      loops_(asks.loops),
      full_bundles_(config.map, asks.bundling),
      keep_map_(std::move(keep_map)),
      map_(std::move(so_far)) {}

void Mapping::take(const ToMapping& message, const MappingLink::Reply& reply) {
  std::visit([&](const auto& kind) { take(kind, reply); }, message);
}

void Mapping::take(const StartMap& message, const MappingLink::Reply& reply) {
  give_up_map();
  map_.has_metric_odometry = config_.odometry.is_used();
  apply(map::start_map(map_, message.view, core::Rigid3{}));
  reply(newest_answer());
  ask_for_loops(message.image, true);
  keep_map();
}

void Mapping::take(const StartMapByMotion& message, const MappingLink::Reply& reply) {
  give_up_map();
  apply(map::start_map(map_, message.views));
  connect_newest();
  refine_newest();
  reply(newest_answer());
  ask_for_loops(message.image, true);
  keep_map();
}

void Mapping::take(const AddKeyframe& message, const MappingLink::Reply& reply) {
  const bool were_parted = hear_loops(config_.map.loop_lag_keyframes - 1);
  if (const auto found = full_bundles_.due(map_)) apply(*found);
  {
    const core::ScopedTimer timer(timings_, "map");
    apply(map::add_keyframe(map_, were_parted
                                      ? map::without_parted(map_, message.tracked, config_.features)
                                      : message.tracked));
  }
  connect_newest();
  reply(newest_answer());
  refine_newest();
  ask_for_loops(message.image);
  full_bundles_.begin(map_);
  add_frames(message.frames);
  keep_map();
  let_old_leave_memory();
}

void Mapping::take(const FindPlace& message, const MappingLink::Reply& reply) {
  hear_loops(0);
  loops_.send(message);
  const LoopAnswer answer = loops_.receive();
  note(answer);
  reply(newest_answer(answer.places));
}

void Mapping::take(const SaveFrames& message, const MappingLink::Reply& /*reply*/) {
  add_frames(message.frames);
  keep_map();
}

void Mapping::take(const EndOfInput& message, const MappingLink::Reply& /*reply*/) {
  hear_loops(0);
  close_waiting_loops();
  if (const auto found = full_bundles_.last(map_)) apply(*found);
  add_frames(message.frames);
  keep_map();
}

void Mapping::give_up_map() {
  hear_loops(config_.map.loop_lag_keyframes - 1);
  full_bundles_.forget();
  apply(map::give_up(map_));
}

void Mapping::connect_newest() {
  const core::KeyframeId newest = map_.keyframes.back().id;
  {
    const core::ScopedTimer timer(timings_, "triangulate");
    apply(map::triangulate_landmarks(map_, newest, config_.map, config_.features));
  }
  const core::ScopedTimer timer(timings_, "fuse");
  for (const auto& edit : map::fuse_around(map_, newest, config_.map, config_.features))
    apply(edit);
}

void Mapping::refine_newest() {
  const core::KeyframeId newest = map_.keyframes.back().id;
  if (!config_.odometry.is_used()) {  // else poses are those of the file
    const core::ScopedTimer timer(timings_, "bundle");
    apply(map::bundle_around(map_, newest, {config_.map, config_.features, config_.optimize}));
  }
  const core::ScopedTimer timer(timings_, "cull");
  apply(map::cull_around(map_, newest, config_.map, config_.features));
}

void Mapping::ask_for_loops(const cv::Mat& image, bool starts_map) {
  loops_.send(FindLoops{map_, map_.keyframes.back().id, image, starts_map});
  ++num_unheard_;
}

void Mapping::close_waiting_loops() {
  if (!config_.close_loops || map_.keyframes.empty()) return;
  std::size_t num_known = 0;
  do {
    num_known = accepted_.size();
    loops_.send(AskAgain{map_});
    ++num_unheard_;
    hear_loops(0);
  } while (accepted_.size() != num_known);
}

bool Mapping::hear_loops(int max_unheard) {
  bool were_parted = false;
  for (; num_unheard_ > max_unheard; --num_unheard_) {
    const LoopAnswer answer = loops_.receive();
    note(answer);
    for (const auto& loop : answer.loops) {
      const AcceptedLoop measured = in_lengths_of_today(map_, loop);
      const bool is_of_today = answer.map_number >= withdrawn_at_;
      const std::optional<AcceptedLoop> heard = is_of_today ? measured : reverified(measured);
      if (heard) were_parted |= correct(*heard);
    }
  }
  return were_parted;
}

void Mapping::note(const LoopAnswer& answer) {
  if (answer.descriptor) news_.descriptors.push_back(*answer.descriptor);
  if (answer.thumbnail) news_.thumbnails.push_back(*answer.thumbnail);
  news_.rows.insert(news_.rows.end(), answer.rows.begin(), answer.rows.end());
  unsent_rows_.insert(unsent_rows_.end(), answer.rows.begin(), answer.rows.end());
  for (const auto& row : answer.rows)
    if (core::is_loop(row.verdict)) accepted_.insert_or_assign(row.candidate.id, row);
}

// The past must be corrected, and what both places show is one.
bool Mapping::correct(const AcceptedLoop& heard) {
  const core::ScopedTimer timer(timings_, "correct");
  const auto loop = correct::between_holders(map_, heard.edge);
  if (!loop) return false;  // both hang on one: nothing to correct
  const Correction correction = with_loop(map_, *loop, config_, heard.overruled);
  const correct::Closing& closing = correction.closing;
  record_changes(closing, *loop);
  map_ = correction.map;
  if (!closing.accepted.empty() && !config_.odometry.is_used()) full_bundles_.note_correction(map_);
  if (!closing.withdrawn.empty()) withdrawn_at_ = map_.number;
  return !closing.withdrawn.empty();
}

std::optional<AcceptedLoop> Mapping::reverified(AcceptedLoop heard) {
  const auto known = accepted_.find(heard.edge.cause);
  if (known == accepted_.end()) return heard;
  verify::OdometryTree odometry = odometry_tree(config_);
  const core::Verdict verdict = reverify(map_, odometry, heard.edge, known->second, config_);
  const auto* loop = std::get_if<core::LoopClosure>(&verdict);
  if (loop == nullptr) {
    add_row({known->second.candidate, verdict});
    return std::nullopt;
  }
  heard.overruled = loop->overruled;
  return heard;
}

void Mapping::record_changes(const correct::Closing& closing, const scene::LoopEdge& newest) {
  if (closing.rejected)
    reject(closing.rejected->loop, core::Refusal::kGraph, bent_by(*closing.rejected, config_));
  for (const auto& bent : closing.withdrawn) {
    reject(bent.loop, core::Refusal::kWithdrawn,
           fmt::format("{}, since frames {} and {} are one place", bent_by(bent, config_),
                       map_.at(newest.query).view.frame.index(),
                       map_.at(newest.match).view.frame.index()));
  }
  for (const auto& loop : closing.accepted)
    if (loop.cause != newest.cause) accept_again(loop);
}

void Mapping::reject(const scene::LoopEdge& loop, core::Refusal stage, const std::string& reason) {
  core::LedgerRow row{{.id = loop.cause,
                       .query = map_.at(loop.query).view.frame,
                       .match = map_.at(loop.match).view.frame},
                      {}};
  const auto known = accepted_.find(loop.cause);  // unless in an earlier session
  if (known != accepted_.end()) row = known->second;
  const core::Evidence evidence = core::evidence_of(row.verdict);
  row.verdict = core::Rejection{loop.cause, evidence, stage, reason};
  add_row(row);
}

void Mapping::accept_again(const scene::LoopEdge& loop) {
  const auto known = accepted_.find(loop.cause);
  if (known != accepted_.end()) add_row(known->second);
}

void Mapping::add_row(const core::LedgerRow& row) {
  news_.rows.push_back(row);
  unsent_rows_.push_back(row);
  later_verdicts_.push_back(row);
}

MapAnswer Mapping::newest_answer(std::vector<Place> places) {
  return {.map = map_,
          .places = std::move(places),
          .rows = std::exchange(unsent_rows_, core::Ledger{})};
}

void Mapping::add_frames(const std::vector<core::FramePose>& frames) {
  news_.frames.insert(news_.frames.end(), frames.begin(), frames.end());
}

void Mapping::keep_map() {
  const MapNews news = std::exchange(news_, {});
  if (map_.keyframes.empty() || !keep_map_) return;
  const core::ScopedTimer timer(timings_, "save");
  keep_map_(map_, news);
}

void Mapping::apply(scene::Edit edit) {
  for (auto& keyframe : edit.keyframes)
    keyframe.view.features = features::paged(keyframe.view.features, feature_memory_);
  map_ = scene::apply(std::move(map_), edit);
}

// Features that fusion, bundle adjustment or loop verification have read since return to memory,
// and leave it at the next round.
void Mapping::let_old_leave_memory() {
  const auto num_kept = static_cast<std::size_t>(config_.map.keyframes_in_memory);
  landmark_pages_.step(map_.landmarks, num_kept);
  const std::size_t num_keyframes = map_.keyframes.size();
  if (num_keyframes <= num_kept) return;
  const std::size_t num_old = num_keyframes - num_kept;
  for (std::size_t i = num_keyframes % num_kept == 0 ? 0 : num_old - 1; i < num_old; ++i)
    features::leave_memory(*map_.keyframes[i].view.features);
}

}  // namespace samewhere::pipeline
