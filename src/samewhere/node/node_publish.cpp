// What a node gives out.

#include <cmath>

#include <fmt/format.h>

#include <samewhere/node/node.hpp>
#include <samewhere/node/outputs.hpp>
#include <samewhere/node/transforms.hpp>

namespace samewhere::node {
namespace {

std::uint8_t level_of(const std::optional<Tracked>& newest) {
  const bool is_well = newest && newest->has_pose();
  return is_well ? messages::DiagnosticStatus::kOk : messages::DiagnosticStatus::kWarn;
}

}  // namespace

void Node::publish_frames(const Tracked& tracked) {
  if (tracked.has_pose()) {
    const Pose map_from_base = frames_.map_from_base();
    const Pose camera_from_body = setup_->calibration.cameras[0].body_from_camera.inverse();
    const Pose base_from_body = setup_->camera_from_base.inverse() * camera_from_body;
    publisher_.pose(pose_message(header_of(config_.map_frame, tracked.stamp_s), map_from_base,
                                 (map_from_base * base_from_body).linear(), tracked.covariance));
  }
  if (has_odometry()) {
    waiting_for_odometry_ = tracked;
    return publish_corrected_odometry();
  }
  publisher_.transforms({{transform_message(config_.map_frame, config_.odom_frame,
                                            tracked.stamp_s + config_.map_to_odom_postdate_s,
                                            frames_.map_from_odom()),
                          transform_message(config_.odom_frame, setup_->base_frame, tracked.stamp_s,
                                            frames_.odom_from_base())}});
}

void Node::publish_corrected_odometry() {
  if (!waiting_for_odometry_) return;
  const double stamp_s = waiting_for_odometry_->stamp_s;
  const std::optional<Pose> odom_from_base = odometry_.at(stamp_s);
  if (!odom_from_base) return;
  if (waiting_for_odometry_->has_pose()) {
    frames_.use_odometry(*odom_from_base);
    map_from_given_odom_ = frames_.map_from_odom();
  }
  waiting_for_odometry_.reset();
  publisher_.transforms(
      {{transform_message(config_.map_frame, config_.odom_frame,
                          stamp_s + config_.map_to_odom_postdate_s, map_from_given_odom_)}});
}

void Node::publish_map_if_due(const Tracked& tracked) {
  const double since_s = tracked.stamp_s - map_told_s_.value_or(-INFINITY);
  if (since_s >= 0.0 && since_s < config_.map_period_s) return;
  map_told_s_ = tracked.stamp_s;
  publish_state();
  const std::shared_ptr<const Map> map = slam_->map();
  const messages::Header header = header_of(config_.map_frame, tracked.stamp_s);
  if (grid_) grid_->make_if_due(header, map);
  if (map->version() == map_version_told_) return;
  map_version_told_ = map->version();
  publisher_.path(path_message(header, *map, setup_->camera_from_base));
  publisher_.landmarks(
      landmarks_message(header, *map, static_cast<std::size_t>(config_.max_landmarks)));
}

void Node::publish_events() {
  messages::DiagnosticArray array{.header = header_of("", newest_ ? newest_->stamp_s : 0.0)};
  for (const Event& event : slam_->take_events()) {
    if (grid_) grid_->take_event(event);
    if (auto status = event_message(event)) array.status.push_back(std::move(*status));
  }
  if (!array.status.empty()) publisher_.diagnostics(array);
}

void Node::publish_state() {
  const Counts so_far = counts();
  messages::DiagnosticStatus state{
      .level = why_not_started_.empty() ? level_of(newest_) : messages::DiagnosticStatus::kError,
      .name = "samewhere: state",
      .message = why_not_started_.empty() ? status_ : why_not_started_,
      .values = {{"frames", fmt::format("{}", so_far.num_frames)},
                 {"images_dropped", fmt::format("{}", so_far.num_dropped)},
                 {"messages_refused", fmt::format("{}", so_far.num_refused)},
                 {"last_refusal", so_far.last_refusal},
                 {"mapping", is_paused_ ? "paused" : "on"}}};
  if (slam_) {
    const std::shared_ptr<const Map> map = slam_->map();
    state.values.push_back({"keyframes", fmt::format("{}", map->num_keyframes())});
    state.values.push_back({"scale", map->is_metric() ? "metres" : "unknown"});
    state.values.push_back({"base_frame", setup_->base_frame});
    if (grid_) state.values.push_back({"no_grid", grid_->why_none()});
  }
  if (newest_) state.values.push_back({"inliers", fmt::format("{}", newest_->num_inliers)});
  publisher_.diagnostics(
      {.header = header_of("", newest_ ? newest_->stamp_s : 0.0), .status = {state}});
}

void Node::set_status(const std::string& status) {
  if (status == status_) return;
  status_ = status;
  publisher_.status({.data = status});
}

}  // namespace samewhere::node
