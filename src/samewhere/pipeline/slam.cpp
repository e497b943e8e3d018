#include <cmath>
#include <utility>

#include <Eigen/LU>

#include <samewhere/core/errors.hpp>
#include <samewhere/geometry/uncertain_pose.hpp>
#include <samewhere/pipeline/slam.hpp>
#include <samewhere/pipeline/slam_test_hooks.hpp>

namespace samewhere::pipeline {
namespace {

// The chain of `num_edges` odometry edges that ends at the keyframe: the keyframes whose edges to
// their parents form it. Empty if an edge is used already, or the session has too few.
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

// A known map goes on by visual odometry.
Config with_visual_odometry(Config config) {
  config.odometry.file.clear();
  return config;
}

geometry::UncertainPose edge_of(const scene::Keyframe& keyframe) {
  return {parent_from_keyframe(keyframe), keyframe.odometry->information.inverse()};
}

}  // namespace

Slam::Slam(const Config& config, DepthFrom depth_from, KeepMap keep_map)
    : Slam(config, depth_from, SlamTestHooks{.keep_map = std::move(keep_map)}) {}

Slam::Slam(const Config& config, const scene::StoredMap& known, Use use, KeepMap keep_map)
    : Slam(config, known, use, SlamTestHooks{.keep_map = std::move(keep_map)}) {}

Slam::Slam(const Config& config, DepthFrom depth_from, const SlamTestHooks& hooks)
    : stages_(config, hooks), tracking_(config, depth_from, stages_.link()) {}

Slam::Slam(const Config& config, const scene::StoredMap& known, Use use, const SlamTestHooks& hooks)
    : stages_(with_visual_odometry(config), known, hooks),
      tracking_(with_visual_odometry(config), known, use == Use::kLocalize, stages_.link()) {
  core::require(!known.map.keyframes.empty(), "a known map holds a keyframe");
}

void Slam::follow(std::shared_ptr<const OdometryPath> odometry) {
  tracking_.follow(std::move(odometry));
}

void Slam::feed(const core::Frame& frame) {
  core::require(!is_finished_ && !is_broken_, "no frame comes after the last, or after an error");
  is_broken_ = true;  // until nothing was thrown
  tracking_.feed(frame);
  is_broken_ = false;
}

void Slam::finish() {
  core::require(!is_finished_ && !is_broken_, "the input ends once, and not after an error");
  is_broken_ = true;
  tracking_.finish();
  stages_.finish();
  last_rows_ = tracking_.newest_rows();
  const core::Ledger& unsent = stages_.mapping().unsent_rows();
  last_rows_.insert(last_rows_.end(), unsent.begin(), unsent.end());
  ledger_ = stages_.loop_closing().ledger();
  const core::Ledger& changes = stages_.mapping().later_verdicts();
  ledger_.insert(ledger_.end(), changes.begin(), changes.end());
  is_broken_ = false;
  is_finished_ = true;
}

const scene::MapVersion& Slam::map() const {
  require_finished();
  return stages_.mapping().map();
}

const core::Ledger& Slam::ledger() const {
  require_finished();
  return ledger_;
}

std::vector<core::Descriptor> Slam::descriptors() const {
  require_finished();
  const PlaceIndex& index = stages_.loop_closing().index();
  std::vector<core::Descriptor> descriptors;
  for (int i = 0; i < index.num_descriptors(); ++i) descriptors.push_back(index.descriptor(i));
  return descriptors;
}

core::Timings Slam::timings() const {
  require_finished();
  core::Timings timings = tracking_.timings();
  timings.add(stages_.timings());
  for (const std::string other : {"verify", "correct", "full bundle"})
    for (const double duration_ms : timings.durations_beside("track", other))
      timings.add("track beside " + other, duration_ms);
  return timings;
}

double Slam::processor_ms_beside() const {
  require_finished();
  return stages_.processor_ms();
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
    if (!is_confirmed(frame)) continue;
    const core::Rigid3& body_from_camera =
        map.at(frame.reference_keyframe).view.rig->body_from_told_camera();
    trajectory.push_back({frame.stamp_s, world_from_frame(frame) * body_from_camera});
  }
  return trajectory;
}

}  // namespace

core::Rigid3 world_from_camera(const scene::MapVersion& map, const core::FramePose& frame) {
  return scene::world_from_frame(map, frame) *
         map.at(frame.reference_keyframe).view.rig->body_from_told_camera();
}

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
