#include <algorithm>

#include <samewhere/core/rigid3.hpp>
#include <samewhere/library/convert.hpp>
#include <samewhere/node/live_frames.hpp>

namespace samewhere::node {
namespace {

constexpr std::size_t kMaxOdometry = 1000;
constexpr double kMaxOdometryStepBack_s = 1.0;

}  // namespace

void OdometryBuffer::add(double stamp_s, const Pose& odom_from_base) {
  if (!poses_.empty() && stamp_s <= poses_.back().stamp_s) {
    if (stamp_s > poses_.back().stamp_s - kMaxOdometryStepBack_s) return;
    poses_.clear();
  }
  poses_.push_back({stamp_s, odom_from_base});
  if (poses_.size() > kMaxOdometry) poses_.pop_front();
}

std::optional<Pose> OdometryBuffer::at(double stamp_s) const {
  const auto after = std::lower_bound(
      poses_.begin(), poses_.end(), stamp_s,
      [](const StampedOdometry& pose, double stamp) { return pose.stamp_s < stamp; });
  if (after == poses_.end()) return std::nullopt;
  if (after->stamp_s == stamp_s) return after->odom_from_base;
  if (after == poses_.begin()) return std::nullopt;
  const StampedOdometry& before = *std::prev(after);
  const double ratio = (stamp_s - before.stamp_s) / (after->stamp_s - before.stamp_s);
  return library::pose_of(core::interpolate(library::rigid_of(before.odom_from_base),
                                            library::rigid_of(after->odom_from_base), ratio));
}

void LiveFrames::update(const Tracked& tracked, const Pose& camera_from_base) {
  const Pose session_from_base = tracked.odom_from_camera * camera_from_base;
  if (is_new_session_ && odom_from_base_)
    odom_from_session_ = *odom_from_base_ * session_from_base.inverse();
  is_new_session_ = false;
  odom_from_base_ = odom_from_session_ * session_from_base;
  map_from_odom_ = tracked.map_from_odom * odom_from_session_.inverse();
}

void LiveFrames::use_odometry(const Pose& odom_from_base) {
  map_from_odom_ = map_from_base() * odom_from_base.inverse();
  odom_from_base_ = odom_from_base;
}

}  // namespace samewhere::node
