#include <Eigen/LU>

#include <samewhere/geometry/camera.hpp>
#include <samewhere/map/mapper.hpp>
#include <samewhere/pipeline/odometry_tracking.hpp>

namespace samewhere::pipeline {
namespace {

// Whether the landmark is seen near where the pose puts it.
bool is_near(const features::View& view, const Eigen::Vector3d& point_in_body, int feature,
             double radius_px) {
  const Eigen::Vector3d in_camera = inverse(view.rig->body_from_camera[0]) * point_in_body;
  const auto pixel = geometry::project_undistorted(view.rig->cameras[0], in_camera);
  return pixel &&
         (*pixel - view.features->undistorted_px[static_cast<std::size_t>(feature)].cast<double>())
                 .norm() <= radius_px;
}

// Matches that agree with one pose; those far from where odometry puts them are left out.
std::vector<features::Match> matches_of(const features::View& view, const scene::LocalMap& map,
                                        const core::Rigid3& reference_from_body,
                                        const track::Tracker& tracker, double radius_px) {
  std::vector<features::Match> near;
  if (map.size() == 0) return near;
  const auto track = tracker.track(view, map, reference_from_body);
  if (!track) return near;
  const core::Rigid3 body_from_reference = inverse(reference_from_body);
  for (const features::Match& match : track->matches) {
    const Eigen::Vector3d& point = map.points_in_reference[static_cast<std::size_t>(match.first)];
    if (is_near(view, body_from_reference * point, match.second, radius_px)) near.push_back(match);
  }
  return near;
}

}  // namespace

std::optional<core::Rigid3> OdometryTracking::motion(double from_s, double to_s) const {
  const auto world_from_first = path_->world_from_body(from_s);
  const auto world_from_last = path_->world_from_body(to_s);
  if (!world_from_first || !world_from_last) return std::nullopt;
  return inverse(*world_from_first) * *world_from_last;
}

scene::TrackedView OdometryTracking::track(const features::View& view, const VisibleMap& map,
                                           const track::Tracker& tracker) const {
  const scene::Keyframe& newest = map.version().keyframes.back();
  const geometry::UncertainPose motion = path_->motion(newest.view.stamp_s, view.stamp_s);
  track::Track track;
  track.matches = matches_of(view, map.local_map(), motion.a_from_b, tracker,
                             config_.odometry.search_radius_px);
  const auto num_matches = static_cast<int>(track.matches.size());
  const bool is_weak = num_matches < config_.track.min_inliers;
  if (is_weak) track.matches.clear();
  track.pose = {.frame = view.frame,
                .stamp_s = view.stamp_s,
                .status = is_weak ? core::FrameStatus::kWeak : core::FrameStatus::kTracking,
                .is_measured = true,
                .reference_keyframe = newest.id,
                .reference_from_frame = motion.a_from_b,
                .information = motion.covariance.inverse(),
                .num_inliers = num_matches};
  return map.tracked_view(view, track);
}

bool OdometryTracking::is_worth_keeping(const scene::MapVersion& map,
                                        const scene::TrackedView& tracked) const {
  constexpr double kLeastRatio = 0.25;  // whatever the view shows
  const core::Rigid3& moved = tracked.pose.reference_from_frame;
  const double distance = moved.translation.norm() / config_.odometry.keyframe_distance_m;
  const double turn = core::angle_rad(moved.rotation) / config_.map.max_turn_rad;
  if (distance >= 1.0 || turn >= 1.0) return true;
  return (distance >= kLeastRatio || turn >= kLeastRatio) &&
         map::is_worth_keeping(map, tracked, config_.map);
}

}  // namespace samewhere::pipeline
