#include <Eigen/LU>

#include <samewhere/geometry/camera.hpp>
#include <samewhere/map/mapper.hpp>
#include <samewhere/pipeline/odometry_images.hpp>
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

// By features, without those far from where odometry puts their landmarks. Nothing if too few are
// left.
std::optional<track::Track> track_near(const features::View& view, const scene::LocalMap& map,
                                       const core::Rigid3& reference_from_body,
                                       const track::Tracker& tracker, const Config& config) {
  if (map.size() == 0) return std::nullopt;
  auto track = tracker.track(view, map, reference_from_body);
  if (!track) return std::nullopt;
  const core::Rigid3 body_from_reference = inverse(reference_from_body);
  std::erase_if(track->matches, [&](const features::Match& match) {
    const Eigen::Vector3d& point = map.points_in_reference[static_cast<std::size_t>(match.first)];
    return !is_near(view, body_from_reference * point, match.second,
                    config.odometry.search_radius_px);
  });
  if (static_cast<int>(track->matches.size()) < config.track.min_inliers) return std::nullopt;
  return track;
}

// In metres without depth, too: odometry has triangulated the landmarks.
std::optional<geometry::UncertainPose> motion_of(const std::optional<track::Track>& track) {
  if (!track) return std::nullopt;
  return geometry::UncertainPose{track->pose.reference_from_frame,
                                 track->pose.information.inverse()};
}

}  // namespace

std::optional<core::Rigid3> OdometryTracking::motion(double from_s, double to_s) const {
  const auto world_from_first = path_->world_from_body(from_s);
  const auto world_from_last = path_->world_from_body(to_s);
  if (!world_from_first || !world_from_last) return std::nullopt;
  return inverse(*world_from_first) * *world_from_last;
}

void OdometryTracking::note_images(double last_s, double view_s) {
  constexpr double kUnseen_s = 1.0;
  if (path_->gap_s(last_s, view_s) > kUnseen_s) unseen_until_s_ = view_s;
}

bool OdometryTracking::is_before_unseen(const scene::Keyframe& keyframe) const {
  return unseen_until_s_ && keyframe.view.stamp_s < *unseen_until_s_;
}

std::optional<scene::TrackedView> OdometryTracking::track(const features::View& view,
                                                          const VisibleMap& map,
                                                          const core::Rigid3& guessed,
                                                          const track::Tracker& tracker) {
  const scene::Keyframe& newest = map.version().keyframes.back();
  const double from_s = newest.view.stamp_s;
  const bool is_in_gap = !has_pose(view.stamp_s);
  const OdometryMotion moved{.before_from_after = path_->motion(from_s, view.stamp_s),
                             .duration_s = view.stamp_s - from_s,
                             .has_gap = is_in_gap || path_->gap_s(from_s, view.stamp_s) > 0.0,
                             .normal_in_before = path_->normal_in_body(from_s)};
  std::optional<track::Track> seen;
  if (!is_before_unseen(newest))
    seen = track_near(view, map.local_map(),
                      moved.has_gap ? guessed : moved.before_from_after.a_from_b, tracker, config_);
  const auto images = motion_of(seen);
  if (is_in_gap && !images) return std::nullopt;
  const CombinedMotion motion =
      combine_with_images(moved, images, systematic_drift(config_.odometry));
  if (images && !moved.has_gap) {
    ++agreement_.num_compared;
    agreement_.num_contradicted += motion.is_contradicted ? 1 : 0;
  }
  track::Track track;
  if (seen) track.matches = seen->matches;
  track.pose = {.frame = view.frame,
                .stamp_s = view.stamp_s,
                .status = seen ? core::FrameStatus::kTracking : core::FrameStatus::kWeak,
                .is_measured = true,
                .reference_keyframe = newest.id,
                .reference_from_frame = motion.a_from_b,
                .information = motion.covariance.inverse(),
                .num_inliers = static_cast<int>(track.matches.size())};
  return map.tracked_view(view, track);
}

bool OdometryTracking::is_worth_keeping(const scene::MapVersion& map,
                                        const scene::TrackedView& tracked) const {
  constexpr double kLeastRatio = 0.25;  // whatever the view shows
  if (is_before_unseen(map.keyframes.back())) return true;
  const core::Rigid3& moved = tracked.pose.reference_from_frame;
  const double distance = moved.translation.norm() / config_.odometry.keyframe_distance_m;
  const double turn = core::angle_rad(moved.rotation) / config_.map.max_turn_rad;
  if (distance >= 1.0 || turn >= 1.0) return true;
  return (distance >= kLeastRatio || turn >= kLeastRatio) &&
         map::is_worth_keeping(map, tracked, config_.map);
}

}  // namespace samewhere::pipeline
