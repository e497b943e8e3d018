#include <utility>

#include <samewhere/correct/loop_corrector.hpp>
#include <samewhere/map/cull.hpp>
#include <samewhere/map/fuse.hpp>
#include <samewhere/map/local_bundle.hpp>
#include <samewhere/map/triangulate.hpp>
#include <samewhere/pipeline/mapping.hpp>

namespace samewhere::pipeline {

Mapping::Mapping(const Config& config, scene::MapVersion so_far, LoopLink& loops, KeepMap keep_map)
    : config_(config), loops_(loops), keep_map_(std::move(keep_map)), map_(std::move(so_far)) {}

void Mapping::take(const ToMapping& message, const MappingLink::Reply& reply) {
  std::visit([&](const auto& kind) { take(kind, reply); }, message);
}

void Mapping::take(const StartMap& message, const MappingLink::Reply& reply) {
  apply(map::start_map(map_, message.view, core::Rigid3{}));
  reply({.map = map_, .place = {}});
  ask_for_loops(message.image);
  keep_map();
}

void Mapping::take(const StartMapByMotion& message, const MappingLink::Reply& reply) {
  hear_loops(config_.map.loop_lag_keyframes - 1);
  apply(map::give_up(map_));
  apply(map::start_map(map_, message.views));
  connect_newest();
  refine_newest();
  reply({.map = map_, .place = {}});
  ask_for_loops(message.image);
  keep_map();
}

void Mapping::take(const AddKeyframe& message, const MappingLink::Reply& reply) {
  hear_loops(config_.map.loop_lag_keyframes - 1);
  {
    const core::ScopedTimer timer(timings_, "map");
    apply(map::add_keyframe(map_, message.tracked));
  }
  connect_newest();
  reply({.map = map_, .place = {}});
  refine_newest();
  ask_for_loops(message.image);
  add_frames(message.frames);
  keep_map();
}

void Mapping::take(const FindPlace& message, const MappingLink::Reply& reply) {
  hear_loops(0);
  loops_.send(message);
  const LoopAnswer answer = loops_.receive();
  note(answer);
  reply({.map = map_, .place = answer.place});
}

void Mapping::take(const EndOfInput& message, const MappingLink::Reply& /*reply*/) {
  hear_loops(0);
  add_frames(message.frames);
  keep_map();
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
  {
    const core::ScopedTimer timer(timings_, "bundle");
    apply(map::bundle_around(map_, newest, {config_.map, config_.features, config_.optimize}));
  }
  const core::ScopedTimer timer(timings_, "cull");
  apply(map::cull_around(map_, newest, config_.map, config_.features));
}

void Mapping::ask_for_loops(const cv::Mat& image) {
  loops_.send(FindLoops{map_, map_.keyframes.back().id, image});
  ++num_unheard_;
}

void Mapping::hear_loops(int max_unheard) {
  for (; num_unheard_ > max_unheard; --num_unheard_) {
    const LoopAnswer answer = loops_.receive();
    note(answer);
    for (const auto& loop : answer.loops) correct(loop);
  }
}

void Mapping::note(const LoopAnswer& answer) {
  if (answer.descriptor) news_.descriptors.push_back(*answer.descriptor);
  news_.rows.insert(news_.rows.end(), answer.rows.begin(), answer.rows.end());
}

// The past must be corrected, and what both places show is one.
void Mapping::correct(const scene::LoopEdge& loop) {
  const core::ScopedTimer timer(timings_, "correct");
  const scene::Holder match = holder_of(map_, loop.match);
  const scene::Holder query = holder_of(map_, loop.query);
  if (query.keyframe == match.keyframe) return;  // both hang on one: nothing to correct
  const scene::LoopEdge edge{
      query.keyframe, match.keyframe,
      match.holder_from_keyframe * loop.match_from_query * inverse(query.holder_from_keyframe),
      loop.information, loop.cause};
  apply(correct::close_loop(map_, edge, config_.optimize));
  for (const auto& edit : map::fuse_across(map_, edge, config_.map, config_.features)) apply(edit);
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

void Mapping::apply(const scene::Edit& edit) { map_ = scene::apply(std::move(map_), edit); }

}  // namespace samewhere::pipeline
