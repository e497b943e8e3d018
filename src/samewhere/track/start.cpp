#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/median.hpp>
#include <samewhere/core/random.hpp>
#include <samewhere/features/pyramid.hpp>
#include <samewhere/geometry/camera.hpp>
#include <samewhere/geometry/essential.hpp>
#include <samewhere/geometry/triangulation.hpp>
#include <samewhere/optimize/motion_only.hpp>
#include <samewhere/track/drift_model.hpp>
#include <samewhere/track/start.hpp>

namespace samewhere::track {
namespace {

using core::Rigid3;
using features::Match;
using features::View;
using geometry::RayPairs;

// The pairs that a motion explains: their rays meet in front of both cameras, close enough to where
// they were seen.
struct Explained {
  std::vector<int> pairs;  // indices, ascending
  std::vector<Eigen::Vector3d> points_in_first;
  std::vector<double> parallax_rad;
};

double squared_px(const Eigen::Vector3d& point, const Eigen::Vector3d& bearing, double focal_px) {
  return focal_px * focal_px * (point.hnormalized() - bearing.hnormalized()).squaredNorm();
}

Explained explain(const RayPairs& pairs, const std::vector<int>& candidates,
                  const Rigid3& second_from_first, const InitializationConfig& config) {
  const double max_squared_px = config.max_error_px * config.max_error_px;
  Explained explained;
  for (const int i : candidates) {
    const auto k = static_cast<std::size_t>(i);
    const auto point = geometry::triangulate(second_from_first, pairs.first[k], pairs.second[k]);
    if (!point || point->z() <= 0.0) continue;
    const Eigen::Vector3d in_second = second_from_first * *point;
    if (in_second.z() <= 0.0) continue;
    if (squared_px(*point, pairs.first[k], pairs.focal_px) > max_squared_px) continue;
    if (squared_px(in_second, pairs.second[k], pairs.focal_px) > max_squared_px) continue;
    explained.pairs.push_back(i);
    explained.points_in_first.push_back(*point);
    explained.parallax_rad.push_back(
        geometry::parallax_rad(second_from_first.rotation, pairs.first[k], pairs.second[k]));
  }
  return explained;
}

struct BestMotion {
  Rigid3 second_from_first;
  Explained explained;
  std::size_t num_explained_by_second = 0;  // of the pairs, by the second best motion
};

BestMotion best_motion(const RayPairs& pairs, const TwoViewModel& model,
                       const InitializationConfig& config) {
  BestMotion best;
  for (const auto& motion : model.motions) {
    Explained explained = explain(pairs, model.inliers, motion, config);
    const std::size_t count = explained.pairs.size();
    const std::size_t best_count = best.explained.pairs.size();
    best.num_explained_by_second =
        std::max(best.num_explained_by_second, std::min(count, best_count));
    if (count > best_count) {
      best.second_from_first = motion;
      best.explained = std::move(explained);
    }
  }
  return best;
}

// The best motion, refined on what it explains.
void refine(BestMotion& best, const RayPairs& pairs, const TwoViewModel& model,
            const InitializationConfig& config) {
  if (static_cast<int>(best.explained.pairs.size()) < config.min_points) return;
  best.second_from_first =
      refine_motion(subset(pairs, best.explained.pairs), best.second_from_first);
  best.explained = explain(pairs, model.inliers, best.second_from_first, config);
}

// The points that have parallax enough, at a median depth of 1.
Start make_start(const BestMotion& best, const std::vector<Match>& matches, bool is_planar,
                 const InitializationConfig& config) {
  Start start;
  start.is_planar = is_planar;
  const Explained& explained = best.explained;
  std::vector<double> depths;
  for (std::size_t i = 0; i < explained.pairs.size(); ++i) {
    if (explained.parallax_rad[i] < config.min_point_parallax_rad) continue;
    start.matches.push_back(matches[static_cast<std::size_t>(explained.pairs[i])]);
    start.points_in_first.push_back(explained.points_in_first[i]);
    depths.push_back(explained.points_in_first[i].z());
  }
  start.median_parallax_rad = core::median(explained.parallax_rad).value_or(0.0);
  start.first_from_second = inverse(best.second_from_first);
  const auto depth = core::median(std::move(depths));
  if (!depth) return start;
  const double scale = 1.0 / *depth;
  for (auto& point : start.points_in_first) point *= scale;
  start.first_from_second.translation *= scale;
  return start;
}

constexpr double degrees(double angle_rad) { return angle_rad * 180.0 / std::numbers::pi; }

// Why a motion is no start; nothing: it is one.
std::optional<NoStart> refusal_of(const Start& start, const BestMotion& best,
                                  const InitializationConfig& config) {
  const std::size_t num_explained = best.explained.pairs.size();
  if (start.median_parallax_rad < config.min_parallax_rad) {
    return NoStart{
        StartRefusal::kLowParallax, 0,
        fmt::format("median parallax {:.2f} degrees, expected {:.2f}",
                    degrees(start.median_parallax_rad), degrees(config.min_parallax_rad))};
  }
  if (static_cast<double>(best.num_explained_by_second) >
      config.max_competing_ratio * static_cast<double>(num_explained)) {
    return NoStart{StartRefusal::kAmbiguous, 0,
                   fmt::format("another motion explains {} of the matches, the best {}",
                               best.num_explained_by_second, num_explained)};
  }
  if (static_cast<int>(start.matches.size()) < config.min_points) {
    return NoStart{StartRefusal::kFewPoints, 0,
                   fmt::format("{} points, expected {}", start.matches.size(), config.min_points)};
  }
  return std::nullopt;
}

// As sure as the second view is located among the points of both.
core::Matrix6d information_of(const Start& start, const View& first, const View& second,
                              const StartSettings& settings) {
  const Rigid3& first_body_from_camera = first.rig->body_from_camera[0];
  const std::vector<double> scales = features::level_scales(settings.features);
  optimize::MotionProblem problem{geometry::pinhole(second.rig->cameras[0]), 0.0, {}};
  for (std::size_t i = 0; i < start.matches.size(); ++i) {
    const auto feature = static_cast<std::size_t>(start.matches[i].second);
    optimize::MotionObservation seen;
    seen.point_in_world = first_body_from_camera * start.points_in_first[i];
    seen.undistorted_px = second.features->undistorted_px[feature].cast<double>();
    seen.sigma_px = scales[static_cast<std::size_t>(second.features->octave[feature])];
    problem.observations.push_back(seen);
  }
  const Rigid3 camera_from_body =
      inverse(start.first_from_second) * inverse(first_body_from_camera);
  const auto located = optimize::refine_pose(problem, camera_from_body, settings.optimize);
  return odometry_information(camera_from_body, second.rig->body_from_camera[0], located.covariance,
                              false, drift_of(second, settings.drift));
}

}  // namespace

Result<Start, NoStart> try_start(const View& first, const View& second,
                                 const StartSettings& settings) {
  core::require(first.rig->is_calibrated() && second.rig->is_calibrated(),
                "only calibrated views start a map");
  const InitializationConfig& config = settings.start;
  const auto matches =
      match_pair(first.features->descriptors, second.features->descriptors, settings.features);
  const auto num_matches = static_cast<int>(matches.size());
  if (num_matches < config.min_matches) {
    return refuse(NoStart{StartRefusal::kFewMatches, num_matches,
                          fmt::format("{} matches, expected {}", num_matches, config.min_matches)});
  }
  const MatchedViews views{first, second, matches};
  const RayPairs pairs = ray_pairs(views);
  core::Random random(core::seed_of(settings.seed, "start", second.frame.value()));
  const auto model = estimate_model(views, pairs, config, random);
  if (!model) return refuse(model.error());
  BestMotion best = best_motion(pairs, *model, config);
  refine(best, pairs, *model, config);
  Start start = make_start(best, matches, model->is_planar, config);
  if (auto reason = refusal_of(start, best, config)) {
    reason->num_matches = num_matches;
    return refuse(*std::move(reason));
  }
  start.information = information_of(start, first, second, settings);
  return start;
}

}  // namespace samewhere::track
