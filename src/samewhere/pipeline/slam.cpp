#include <cmath>
#include <utility>

#include <Eigen/LU>

#include <samewhere/core/background.hpp>
#include <samewhere/core/errors.hpp>
#include <samewhere/geometry/uncertain_pose.hpp>
#include <samewhere/pipeline/slam.hpp>

namespace samewhere::pipeline {
namespace {

template <class Message, class Answer>
std::unique_ptr<core::Link<Message, Answer>> link_to(
    typename core::Link<Message, Answer>::Serve stage, bool in_thread, int capacity,
    core::Dawdle dawdle) {
  if (!in_thread) return std::make_unique<core::DirectLink<Message, Answer>>(std::move(stage));
  return std::make_unique<core::ThreadLink<Message, Answer>>(
      std::move(stage), static_cast<std::size_t>(capacity), std::move(dawdle));
}

// Mapping asks about a keyframe before it hears the answer to the one `lag` before it.
std::unique_ptr<LoopLink> link_to(LoopClosing& stage, const Config& config,
                                  const SlamHooks& hooks) {
  return link_to<ToLoopClosing, LoopAnswer>(
      [&stage, lie = hooks.lie](const ToLoopClosing& message, const LoopLink::Reply& reply) {
        LoopAnswer answer = stage.answer(message);
        if (lie) lie(message, answer);
        reply(std::move(answer));
      },
      config.threads, config.map.loop_lag_keyframes, hooks.dawdle);
}

// One full bundle is under way at most. It takes seconds and tracking is to feel little of it.
std::unique_ptr<BundleLink> link_to(Bundling& stage, const Config& config, const SlamHooks& hooks) {
  return link_to<BundleAll, scene::Edit>(
      [&stage, in_thread = config.threads](const BundleAll& message,
                                           const BundleLink::Reply& reply) {
        if (in_thread) core::work_in_background();
        reply(stage.answer(message));
      },
      config.threads, 1, hooks.dawdle);
}

// One keyframe is under way at most.
std::unique_ptr<MappingLink> link_to(Mapping& stage, const Config& config, const SlamHooks& hooks) {
  return link_to<ToMapping, MapAnswer>(
      [&stage](const ToMapping& message, const MappingLink::Reply& reply) {
        stage.take(message, reply);
      },
      config.threads, 1, hooks.dawdle);
}

// The keyframe and those before it, `num_edges` in all, whose edges to their parents make a chain;
// nothing if one of them is used or the session begins too late.
std::vector<core::KeyframeId> edges_before(const scene::MapVersion& map, core::KeyframeId id,
                                           int num_edges, const std::vector<bool>& is_used) {
  std::vector<core::KeyframeId> edges;
  while (static_cast<int>(edges.size()) < num_edges) {
    const auto& odometry = map.at(id).odometry;
    if (!odometry || is_used[id.index()]) return {};
    edges.push_back(id);
    id = odometry->parent;
  }
  return edges;
}

geometry::UncertainPose edge_of(const scene::Keyframe& keyframe) {
  return {parent_from_keyframe(keyframe), keyframe.odometry->information.inverse()};
}

}  // namespace

Slam::Slam(const Config& config, DepthFrom depth_from, const SlamHooks& hooks)
    : loop_closing_(config),
      loop_link_(link_to(loop_closing_, config, hooks)),
      bundling_(config),
      bundle_link_(link_to(bundling_, config, hooks)),
      mapping_(config, {}, {*loop_link_, *bundle_link_}, hooks.keep_map),
      mapping_link_(link_to(mapping_, config, hooks)),
      tracking_(config, depth_from, *mapping_link_) {}

Slam::Slam(const Config& config, const scene::StoredMap& known, Use use, const SlamHooks& hooks)
    : loop_closing_(config, known),
      loop_link_(link_to(loop_closing_, config, hooks)),
      bundling_(config),
      bundle_link_(link_to(bundling_, config, hooks)),
      mapping_(config, known.map, {*loop_link_, *bundle_link_}, hooks.keep_map),
      mapping_link_(link_to(mapping_, config, hooks)),
      tracking_(config, known, use == Use::kLocalize, *mapping_link_) {
  core::require(!known.map.keyframes.empty(), "a known map holds a keyframe");
}

void Slam::feed(const core::Frame& frame) {
  core::require(!is_finished_ && !is_broken_, "no frame comes after the last, or after an error");
  is_broken_ = true;  // until it is known that nothing was thrown
  tracking_.feed(frame);
  is_broken_ = false;
}

void Slam::finish() {
  core::require(!is_finished_ && !is_broken_, "the input ends once, and not after an error");
  is_broken_ = true;
  tracking_.finish();
  mapping_link_->finish();
  loop_link_->finish();
  bundle_link_->finish();
  ledger_ = loop_closing_.ledger();
  ledger_.insert(ledger_.end(), mapping_.second_thoughts().begin(),
                 mapping_.second_thoughts().end());
  is_broken_ = false;
  is_finished_ = true;
}

const scene::MapVersion& Slam::map() const {
  require_finished();
  return mapping_.map();
}

const core::Ledger& Slam::ledger() const {
  require_finished();
  return ledger_;
}

std::vector<core::Descriptor> Slam::descriptors() const {
  require_finished();
  const PlaceIndex& index = loop_closing_.index();
  std::vector<core::Descriptor> descriptors;
  for (int i = 0; i < index.num_descriptors(); ++i) descriptors.push_back(index.descriptor(i));
  return descriptors;
}

core::Timings Slam::timings() const {
  require_finished();
  core::Timings timings = tracking_.timings();
  timings.add(mapping_.timings());
  timings.add(loop_closing_.timings());
  timings.add(bundling_.timings());
  for (const std::string other : {"verify", "correct", "full bundle"})
    for (const double duration_ms : timings.durations_beside("track", other))
      timings.add("track beside " + other, duration_ms);
  return timings;
}

double Slam::processor_ms_beside() const {
  require_finished();
  return mapping_link_->processor_ms() + loop_link_->processor_ms() + bundle_link_->processor_ms();
}

void Slam::require_finished() const {
  core::require(is_finished_, "what the stages own is looked at when they have ended");
}

namespace {

// Frames placed in the world.
template <class WorldFromFrame>
core::Trajectory placed(const scene::MapVersion& map, const std::vector<core::FramePose>& frames,
                        const WorldFromFrame& world_from_frame) {
  core::Trajectory trajectory;
  for (const auto& frame : frames) {
    if (!frame.is_measured) continue;
    const core::Rigid3& body_from_camera =
        map.at(frame.reference_keyframe).view.rig->body_from_told_camera();
    trajectory.push_back({frame.stamp_s, world_from_frame(frame) * body_from_camera});
  }
  return trajectory;
}

}  // namespace

core::Trajectory trajectory_of(const scene::MapVersion& map,
                               const std::vector<core::FramePose>& frames) {
  return placed(map, frames,
                [&](const core::FramePose& frame) { return scene::world_from_frame(map, frame); });
}

core::Trajectory odometry_of(const scene::MapVersion& map,
                             const std::vector<core::FramePose>& frames) {
  const std::vector<core::Rigid3> world_from_body = scene::odometry_poses(map);
  return placed(map, frames, [&](const core::FramePose& frame) {
    core::Rigid3 reference_from_frame = frame.reference_from_frame;
    reference_from_frame.translation *= std::exp(-frame.log_scale);
    return world_from_body[frame.reference_keyframe.index()] * reference_from_frame;
  });
}

std::vector<evaluate::MeasuredMotion> odometry_chains_of(const scene::MapVersion& map,
                                                         std::uint16_t session, int num_edges) {
  std::vector<evaluate::MeasuredMotion> chains;
  std::vector<bool> is_used(map.keyframes.size(), false);  // the edge to the parent
  for (std::size_t i = map.keyframes.size(); i-- > 0;) {
    const scene::Keyframe& last = map.keyframes[i];
    if (last.view.frame.session() != session) continue;
    const auto edges = edges_before(map, last.id, num_edges, is_used);
    if (edges.empty()) continue;
    geometry::UncertainPose first_from_last;
    for (const auto& id : edges) {
      is_used[id.index()] = true;
      first_from_last = compose(edge_of(map.at(id)), first_from_last);
    }
    const scene::Keyframe& first = map.at(map.at(edges.back()).odometry->parent);
    const geometry::UncertainPose body_from_camera{last.view.rig->body_from_camera[0]};
    chains.push_back(
        {first.view.stamp_s, last.view.stamp_s,
         compose(inverse(body_from_camera), compose(first_from_last, body_from_camera))});
  }
  return chains;
}

}  // namespace samewhere::pipeline
