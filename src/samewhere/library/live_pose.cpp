#include <samewhere/library/live_pose.hpp>

namespace samewhere::library {

void LivePose::update(const pipeline::Slam& slam) {
  constexpr double kPredicted_s = 0.5;
  const pipeline::NewestFrame& newest = slam.newest();
  const double stamp_s = slam.frames().back().stamp_s;
  if (newest.last_from_newest) {
    last_motion_ = *newest.last_from_newest;
    odom_from_body_ = odom_from_body_ * last_motion_;
  } else if (last_pose_s_ && stamp_s - *last_pose_s_ <= kPredicted_s) {
    odom_from_body_ = odom_from_body_ * last_motion_;
  }
  odom_from_body_.rotation.normalize();
  provisional_.reset();
  if (!newest.pose) return;
  const core::Rigid3 map_from_body = world_from_frame(slam.visible_map(), *newest.pose);
  if (!is_confirmed(*newest.pose)) {
    provisional_ = map_from_body;
    return;
  }
  map_from_odom_ = map_from_body * inverse(odom_from_body_);
  last_pose_s_ = stamp_s;
}

}  // namespace samewhere::library
