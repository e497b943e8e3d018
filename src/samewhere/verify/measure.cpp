#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>

#include <samewhere/core/median.hpp>
#include <samewhere/core/random.hpp>
#include <samewhere/features/match_pair.hpp>
#include <samewhere/features/match_projected.hpp>
#include <samewhere/features/stereo.hpp>
#include <samewhere/geometry/camera.hpp>
#include <samewhere/geometry/pnp.hpp>
#include <samewhere/geometry/two_view.hpp>
#include <samewhere/optimize/motion_only.hpp>
#include <samewhere/verify/decide.hpp>
#include <samewhere/verify/epipolar.hpp>
#include <samewhere/verify/measure.hpp>
#include <samewhere/verify/overlap.hpp>

namespace samewhere::verify {
namespace {

using core::GeometryEvidence;
using features::Match;  // first = feature of the match, second = feature of the query
using features::View;

constexpr int kSpreadCells = 8;
constexpr int kMinPointsForPose = 12;

// Share of the query image's 8 x 8 cells that hold one of these features.
double spread_ratio(const View& query, const std::vector<Match>& inliers) {
  std::set<std::pair<int, int>> cells;
  for (const Match& inlier : inliers) {
    const Eigen::Vector2f& pixel = query.features->raw_px[static_cast<std::size_t>(inlier.second)];
    cells.insert(
        {static_cast<int>(pixel.x() * kSpreadCells / static_cast<float>(query.image_size_px.width)),
         static_cast<int>(pixel.y() * kSpreadCells /
                          static_cast<float>(query.image_size_px.height))});
  }
  return static_cast<double>(cells.size()) / (kSpreadCells * kSpreadCells);
}

// The points of the match in its body frame; nothing where depth is unknown.
std::vector<std::optional<Eigen::Vector3d>> points_of(const View& match) {
  std::vector<std::optional<Eigen::Vector3d>> points;
  for (int i = 0; i < match.features->size(); ++i) {
    auto point = features::point_in_camera(match, i);
    if (point) point = match.rig->body_from_camera[0] * *point;
    points.push_back(point);
  }
  return points;
}

// One candidate with depth: everything the steps below share.
class PoseMeasurement {
 public:
  PoseMeasurement(const View& query, const View& match, const MeasureSettings& settings)
      : query_(query), match_(match), settings_(settings), points_(points_of(match)) {}
  PoseMeasurement(const PoseMeasurement&) = delete;
  PoseMeasurement& operator=(const PoseMeasurement&) = delete;

  GeometryEvidence measure(const std::vector<Match>& matches, core::Random& random) const {
    GeometryEvidence evidence;
    evidence.num_matches = static_cast<int>(matches.size());
    const std::vector<Match> with_point = usable(matches);
    const auto pose = geometry::estimate_pose(pnp_problem(with_point),
                                              {.max_error_px = settings_.verify.max_error_px,
                                               .max_iterations = settings_.verify.ransac_iterations,
                                               .min_inliers = kMinPointsForPose},
                                              random);
    if (!pose) return evidence;
    const auto coarse = refine_pose(motion_problem(with_point), pose->model, settings_.optimize);
    const std::vector<Match> again = second_look(coarse.camera_from_world);
    const auto fine =
        refine_pose(motion_problem(again), coarse.camera_from_world, settings_.optimize);
    // the ratio speaks of the first, blind matches: the second look finds what fits by construction
    evidence.inlier_ratio =
        static_cast<double>(pose->inliers.size()) / std::max<double>(1.0, evidence.num_matches);
    evidence.num_guided_matches = static_cast<int>(again.size());
    evidence.num_inliers = fine.num_inliers;
    evidence.reprojection_rmse_px = fine.reprojection_rmse_px;
    const std::vector<Match> inliers = inliers_of(again, fine);
    evidence.spread_ratio = spread_ratio(query_, inliers);
    evidence.overlap_ratio = overlap_ratio(pixels_of(query_, match_, inliers), match_.image_size_px,
                                           query_.image_size_px);
    const std::optional<double> scale =
        settings_.has_one_scale ? std::optional(1.0) : scale_of(again, fine);
    if (!scale) return evidence;
    const core::Rigid3 match_from_query =
        inverse(query_.rig->body_from_camera[0] * fine.camera_from_world);
    evidence.match_from_query =
        core::Sim3{*scale, match_from_query.rotation, match_from_query.translation};
    return evidence;
  }

 private:
  std::vector<Match> usable(const std::vector<Match>& matches) const {
    std::vector<Match> with_point;
    for (const auto& match : matches) {
      if (points_[static_cast<std::size_t>(match.first)]) with_point.push_back(match);
    }
    return with_point;
  }

  geometry::PnpProblem pnp_problem(const std::vector<Match>& matches) const {
    const core::Camera& camera = query_.rig->cameras[0];
    geometry::PnpProblem problem;
    problem.focal_px = geometry::focal_px(camera);
    for (const auto& match : matches) {
      const auto pixel =
          query_.features->undistorted_px[static_cast<std::size_t>(match.second)].cast<double>();
      problem.points_in_world.push_back(*points_[static_cast<std::size_t>(match.first)]);
      problem.bearings.push_back(geometry::bearing_of_undistorted(camera, pixel));
    }
    return problem;
  }

  optimize::MotionProblem motion_problem(const std::vector<Match>& matches) const {
    optimize::MotionProblem problem{geometry::pinhole(query_.rig->cameras[0]),
                                    features::baseline_m(*query_.rig, settings_.features),
                                    {}};
    for (const auto& match : matches) {
      const auto feature = static_cast<std::size_t>(match.second);
      problem.observations.push_back(
          {*points_[static_cast<std::size_t>(match.first)],
           query_.features->undistorted_px[feature].cast<double>(),
           query_.features->right_x_px[feature],
           std::pow(settings_.features.scale_factor, query_.features->octave[feature])});
    }
    return problem;
  }

  std::vector<Match> second_look(const core::Rigid3& camera_from_match) const {
    std::vector<features::ProjectedPoint> projected;
    for (int i = 0; i < match_.features->size(); ++i) {
      const auto& point = points_[static_cast<std::size_t>(i)];
      if (!point) continue;
      const Eigen::Vector3d in_query = camera_from_match * *point;
      const auto pixel = geometry::project_undistorted(query_.rig->cameras[0], in_query);
      if (!pixel) continue;
      const int octave = features::octave_at(match_.features->octave[static_cast<std::size_t>(i)],
                                             point->norm(), in_query.norm(), settings_.features);
      projected.push_back({i, *pixel, octave});
    }
    return match_projected(projected, match_.features->descriptors, query_,
                           settings_.verify.refine_radius_px, settings_.features);
  }

  // How long at the match is what is 1 long at the query; nothing if too few inliers have a depth
  // at both.
  std::optional<double> scale_of(const std::vector<Match>& matches,
                                 const optimize::MotionResult& motion) const {
    std::vector<double> ratios;
    for (std::size_t i = 0; i < matches.size(); ++i) {
      const double depth = query_.features->depth_m[static_cast<std::size_t>(matches[i].second)];
      if (!motion.is_inlier[i] || depth <= 0.0) continue;
      const auto& point = *points_[static_cast<std::size_t>(matches[i].first)];
      ratios.push_back((motion.camera_from_world * point).z() / depth);
    }
    if (static_cast<int>(ratios.size()) < kMinPointsForPose) return std::nullopt;
    return core::median(std::move(ratios));
  }

  static std::vector<Match> inliers_of(const std::vector<Match>& matches,
                                       const optimize::MotionResult& motion) {
    std::vector<Match> inliers;
    for (std::size_t i = 0; i < matches.size(); ++i) {
      if (motion.is_inlier[i]) inliers.push_back(matches[i]);
    }
    return inliers;
  }

  const View& query_;
  const View& match_;
  const MeasureSettings& settings_;
  std::vector<std::optional<Eigen::Vector3d>> points_;
};

std::vector<Match> swapped(std::vector<Match> matches) {
  for (auto& match : matches) std::swap(match.first, match.second);
  return matches;
}

// The pose from the match's depth, and, where the query has depth too, that from the query's: how
// far they are apart says how well the views fix it, and their mean is better than either.
GeometryEvidence measure_both_ways(const View& query, const View& match,
                                   const std::vector<Match>& matches,
                                   const MeasureSettings& settings, core::Random& random) {
  GeometryEvidence evidence = PoseMeasurement(query, match, settings).measure(matches, random);
  if (!evidence.match_from_query || !has_depth(query)) return evidence;
  const GeometryEvidence back =
      PoseMeasurement(match, query, settings).measure(swapped(matches), random);
  if (!back.match_from_query) {
    // one view alone finds a pose: they could not disagree more
    evidence.pose_difference_m = std::numeric_limits<double>::infinity();
    evidence.pose_difference_rad = std::numeric_limits<double>::infinity();
    return evidence;
  }
  const core::Sim3 forth = *evidence.match_from_query;
  const core::Sim3 forth_again = inverse(*back.match_from_query);
  const core::Rigid3 apart = inverse(rigid_part(forth)) * rigid_part(forth_again);
  evidence.pose_difference_m = apart.translation.norm();
  evidence.pose_difference_rad = core::angle_rad(apart.rotation);
  const core::Rigid3 mean = interpolate(rigid_part(forth), rigid_part(forth_again), 0.5);
  evidence.match_from_query =
      core::Sim3{std::sqrt(forth.scale * forth_again.scale), mean.rotation, mean.translation};
  return evidence;
}

GeometryEvidence measure_epipolar(const View& query, const View& match,
                                  const std::vector<Match>& matches, const Config& config,
                                  core::Random& random) {
  GeometryEvidence evidence;
  evidence.num_matches = static_cast<int>(matches.size());
  const auto found = epipolar_inliers(query, match, matches, config, random);
  if (!found) return evidence;
  double sum_squared = 0.0;
  for (std::size_t i = 0; i < found->matches.size(); ++i) {
    sum_squared += geometry::sampson_squared(found->fundamental, found->pairs.first_px[i],
                                             found->pairs.second_px[i]);
  }
  evidence.num_inliers = static_cast<int>(found->matches.size());
  evidence.inlier_ratio = static_cast<double>(evidence.num_inliers) / evidence.num_matches;
  evidence.reprojection_rmse_px = std::sqrt(sum_squared / evidence.num_inliers);
  evidence.spread_ratio = spread_ratio(query, found->matches);
  evidence.overlap_ratio = overlap_ratio(found->pairs, match.image_size_px, query.image_size_px);
  return evidence;
}

// Recognition alone: depth reaches fewer features than the image has, so that it adds a pose, and
// does not replace the inliers.
GeometryEvidence with_pose_of(const GeometryEvidence& by_depth, GeometryEvidence by_pixels,
                              const Config& config) {
  if (by_pixels.num_inliers < by_depth.num_inliers) return by_depth;
  if (!has_geometry({.geometry = by_depth}, config)) return by_pixels;
  by_pixels.match_from_query = by_depth.match_from_query;
  by_pixels.pose_difference_m = by_depth.pose_difference_m;
  by_pixels.pose_difference_rad = by_depth.pose_difference_rad;
  return by_pixels;
}

}  // namespace

GeometryEvidence measure_geometry(const core::Candidate& candidate, const View& query,
                                  const View& match, const MeasureSettings& settings) {
  core::Random random = random_of(candidate, settings);
  const std::vector<Match> matches =
      match_pair(match.features->descriptors, query.features->descriptors, settings.features);
  const bool can_have_pose =
      query.rig->is_calibrated() && match.rig->is_calibrated() && has_depth(match);
  GeometryEvidence by_depth;
  if (can_have_pose) by_depth = measure_both_ways(query, match, matches, settings, random);
  if (can_have_pose && !needs_sequences(settings.verify)) return by_depth;
  return with_pose_of(by_depth, measure_epipolar(query, match, matches, settings.verify, random),
                      settings.verify);
}

}  // namespace samewhere::verify
