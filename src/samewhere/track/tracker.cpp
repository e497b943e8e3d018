#include <algorithm>

#include <samewhere/core/random.hpp>
#include <samewhere/features/pyramid.hpp>
#include <samewhere/features/stereo.hpp>
#include <samewhere/geometry/camera.hpp>
#include <samewhere/geometry/pnp.hpp>
#include <samewhere/track/drift_model.hpp>
#include <samewhere/track/tracker.hpp>

namespace samewhere::track {
namespace {

using features::Match;
using features::View;
using scene::LocalMap;

core::Rigid3 camera_from_reference(const View& view, const core::Rigid3& reference_from_body) {
  return inverse(reference_from_body * view.rig->body_from_camera[0]);
}

core::Rigid3 reference_from_body(const View& view, const core::Rigid3& camera_from_reference) {
  return inverse(view.rig->body_from_camera[0] * camera_from_reference);
}

geometry::PnpProblem pnp_problem(const View& view, const LocalMap& map,
                                 const std::vector<Match>& matches) {
  const core::Camera& camera = view.rig->cameras[0];
  geometry::PnpProblem problem;
  problem.focal_px = geometry::focal_px(camera);
  for (const auto& match : matches) {
    const Eigen::Vector2d pixel =
        view.features->undistorted_px[static_cast<std::size_t>(match.second)].cast<double>();
    problem.points_in_world.push_back(
        map.points_in_reference[static_cast<std::size_t>(match.first)]);
    problem.bearings.push_back(geometry::bearing_of_undistorted(camera, pixel));
  }
  return problem;
}

bool is_inside(const Eigen::Vector2d& pixel, const cv::Size& size_px, double margin_px) {
  return pixel.x() > -margin_px && pixel.y() > -margin_px &&
         pixel.x() < size_px.width + margin_px && pixel.y() < size_px.height + margin_px;
}

}  // namespace

std::vector<Match> Tracker::search(const View& view, const LocalMap& map,
                                   const core::Rigid3& reference_from_body,
                                   double radius_px) const {
  const core::Rigid3 from_reference = camera_from_reference(view, reference_from_body);
  std::vector<features::ProjectedPoint> points;
  for (int i = 0; i < map.size(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    const Eigen::Vector3d in_camera = from_reference * map.points_in_reference[k];
    const auto pixel = geometry::project_undistorted(view.rig->cameras[0], in_camera);
    if (!pixel || !is_inside(*pixel, view.image_size_px, radius_px)) continue;
    const int octave =
        features::octave_at(map.octave[k], map.range_m[k], in_camera.norm(), settings_.features);
    points.push_back({i, *pixel, octave});
  }
  return match_projected(points, map.descriptors, view, radius_px, settings_.features);
}

optimize::MotionProblem Tracker::motion_problem(const View& view, const LocalMap& map,
                                                const std::vector<Match>& matches) const {
  optimize::MotionProblem problem{geometry::pinhole(view.rig->cameras[0]),
                                  features::baseline_m(*view.rig, settings_.features),
                                  {}};
  const std::vector<double> scales = features::level_scales(settings_.features);
  for (const auto& match : matches) {
    const auto feature = static_cast<std::size_t>(match.second);
    optimize::MotionObservation seen;
    seen.point_in_world = map.points_in_reference[static_cast<std::size_t>(match.first)];
    seen.undistorted_px = view.features->undistorted_px[feature].cast<double>();
    seen.right_x_px = view.features->right_x_px[feature];
    seen.sigma_px = scales[static_cast<std::size_t>(view.features->octave[feature])];
    problem.observations.push_back(seen);
  }
  return problem;
}

Track Tracker::make_track(const View& view, const LocalMap& map, const std::vector<Match>& matches,
                          const optimize::MotionResult& motion) const {
  Track track;
  for (std::size_t i = 0; i < matches.size(); ++i) {
    if (motion.is_inlier[i]) track.matches.push_back(matches[i]);
  }
  const bool is_weak = motion.num_inliers < settings_.track.weak_inliers;
  track.pose.frame = view.frame;
  track.pose.stamp_s = view.stamp_s;
  track.pose.status = is_weak ? core::FrameStatus::kWeak : core::FrameStatus::kTracking;
  track.pose.is_measured = true;
  track.pose.reference_keyframe = map.reference;
  track.pose.reference_from_frame = reference_from_body(view, motion.camera_from_world);
  track.pose.information =
      odometry_information(motion.camera_from_world, view.rig->body_from_camera[0],
                           motion.covariance, is_weak, drift_of(view, settings_.track.drift));
  track.pose.num_inliers = motion.num_inliers;
  track.reprojection_rmse_px = motion.reprojection_rmse_px;
  return track;
}

std::optional<Track> Tracker::solve(const View& view, const LocalMap& map,
                                    const std::vector<Match>& matches) const {
  const Config& config = settings_.track;
  core::Random random(core::seed_of(settings_.seed, "track", view.frame.value()));
  const auto found = geometry::estimate_pose(pnp_problem(view, map, matches),
                                             {.max_error_px = config.max_error_px,
                                              .max_iterations = config.ransac_iterations,
                                              .min_inliers = config.min_inliers},
                                             random);
  if (!found) return std::nullopt;
  const auto coarse =
      refine_pose(motion_problem(view, map, matches), found->model, settings_.optimize);

  // a second look: with the pose known, what the first search missed is found close to where it
  // should be
  const std::vector<Match> again = search(
      view, map, reference_from_body(view, coarse.camera_from_world), config.refine_radius_px);
  const auto fine =
      refine_pose(motion_problem(view, map, again), coarse.camera_from_world, settings_.optimize);
  if (fine.num_inliers < config.min_inliers) return std::nullopt;
  return make_track(view, map, again, fine);
}

std::optional<Track> Tracker::track(const View& view, const LocalMap& map,
                                    const core::Rigid3& guessed_reference_from_body) const {
  const Config& config = settings_.track;
  std::optional<Track> best;
  const auto has = [&](int num_inliers) { return best && best->pose.num_inliers >= num_inliers; };
  const auto offer = [&](std::optional<Track> track) {
    if (track && !has(track->pose.num_inliers)) best = std::move(track);
  };
  const auto search_around = [&](double radius_px) {
    offer(solve(view, map, search(view, map, guessed_reference_from_body, radius_px)));
  };
  search_around(config.near_radius_px);
  // On a floor full of small spots the near ones agree with each other by chance, even if the
  // camera turned by more than the radius: a pose that few support must be the best of a wide
  // search too.
  if (!has(std::max(config.sure_inliers, config.weak_inliers))) search_around(config.far_radius_px);
  if (!has(config.weak_inliers)) offer(track_anywhere(view, map));
  return best;
}

Track Tracker::track_at(const View& view, const LocalMap& map,
                        const core::Rigid3& reference_from_body, const Alignment& alignment) const {
  const core::Rigid3 given = camera_from_reference(view, reference_from_body);
  const std::vector<Match> matches =
      search(view, map, reference_from_body, settings_.track.refine_radius_px);
  const optimize::MotionProblem problem = motion_problem(view, map, matches);
  const optimize::MotionResult refined = refine_pose(problem, given, settings_.optimize);
  if (refined.num_inliers >= settings_.track.min_inliers &&
      !are_apart(given, refined.camera_from_world))
    return make_track(view, map, matches, refined);
  optimize::Config in_place = settings_.optimize;
  in_place.motion_iterations = 0;
  optimize::MotionResult held = refine_pose(problem, given, in_place);
  held.num_inliers = std::min(held.num_inliers, settings_.track.weak_inliers - 1);
  held.covariance = covariance_of_later(alignment, given);
  return make_track(view, map, matches, held);
}

std::optional<Track> Tracker::track_anywhere(const View& view, const LocalMap& map) const {
  if (map.num_near == 0) return std::nullopt;  // nor has a matrix without rows any to cut from
  return solve(view, map,
               match_pair(map.descriptors.rowRange(0, map.num_near), view.features->descriptors,
                          settings_.features));
}

}  // namespace samewhere::track
