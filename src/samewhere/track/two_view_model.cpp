#include <optional>

#include <fmt/format.h>

#include <samewhere/geometry/camera.hpp>
#include <samewhere/geometry/essential.hpp>
#include <samewhere/geometry/homography.hpp>
#include <samewhere/geometry/two_view.hpp>
#include <samewhere/track/two_view_model.hpp>

namespace samewhere::track {
namespace {

using core::Rigid3;
using features::View;
using geometry::RayPairs;

const core::Camera& camera_of(const View& view) { return view.rig->cameras[0]; }

Eigen::Vector2d undistorted_px(const View& view, int feature) {
  return view.features->undistorted_px[static_cast<std::size_t>(feature)].cast<double>();
}

geometry::PixelPairs pixel_pairs(const MatchedViews& views) {
  geometry::PixelPairs pairs;
  for (const auto& match : views.matches) {
    pairs.first_px.push_back(undistorted_px(views.first, match.first));
    pairs.second_px.push_back(undistorted_px(views.second, match.second));
  }
  return pairs;
}

// The score of a model in ORB-SLAM, eq. (2): what each error leaves of the largest one.
template <class ErrorOf>
double model_score(const RayPairs& pairs, double max_squared_px, const ErrorOf& error_of) {
  constexpr double kLargest = 5.99;  // 95 % of chi-square with 2 degrees of freedom, sigma 1 px
  double score = 0.0;
  for (int i = 0; i < pairs.size(); ++i) {
    const geometry::TransferError error = error_of(i);
    if (error.in_first < max_squared_px) score += kLargest - error.in_first;
    if (error.in_second < max_squared_px) score += kLargest - error.in_second;
  }
  return score;
}

double homography_score(const geometry::Homography& homography, const RayPairs& pairs) {
  return model_score(pairs, 5.99, [&](int i) { return transfer_error(homography, pairs, i); });
}

double epipolar_score(const Eigen::Matrix3d& essential, const RayPairs& pairs) {
  return model_score(pairs, 3.84, [&](int i) { return epipolar_error(essential, pairs, i); });
}

struct ModelScores {
  double homography = 0.0;
  double epipolar = 0.0;

  double homography_ratio() const { return homography / (homography + epipolar); }
  bool prefers_homography(const InitializationConfig& config) const {
    return homography > config.min_homography_ratio * (homography + epipolar);
  }
};

ModelScores scores_of(const geometry::Homography& homography, const Eigen::Matrix3d& essential,
                      const RayPairs& pairs) {
  return {homography_score(homography, pairs), epipolar_score(essential, pairs)};
}

TwoViewModel planar_model(const geometry::RansacResult<geometry::Homography>& homography) {
  TwoViewModel model{{}, homography.inliers, true};
  for (const auto& motion : motions_of(homography.model)) {
    const Rigid3& moved = motion.second_from_first;
    model.motions.push_back({moved.rotation, moved.translation.normalized()});
  }
  return model;
}

TwoViewModel general_model(const Eigen::Matrix3d& essential, const std::vector<int>& inliers) {
  const auto motions = geometry::motions_of_essential(essential);
  return {{motions.begin(), motions.end()}, inliers, false};
}

geometry::RansacOptions ransac_options(const InitializationConfig& config) {
  return {.max_error_px = config.max_error_px,
          .max_iterations = config.ransac_iterations,
          .min_inliers = config.min_points};
}

NoStart no_model(const RayPairs& pairs, const InitializationConfig& config) {
  return {StartRefusal::kFewMatches, pairs.size(),
          fmt::format("of {} matches fewer than {} agree with any motion", pairs.size(),
                      config.min_points)};
}

Result<TwoViewModel, NoStart> homography_or_essential(const RayPairs& pairs,
                                                      const InitializationConfig& config,
                                                      core::Random& random) {
  const auto homography = estimate_homography(pairs, ransac_options(config), random);
  const auto essential = estimate_essential(pairs, ransac_options(config), random);
  if (!homography && !essential) return refuse(no_model(pairs, config));
  if (!homography) return general_model(essential->model, essential->inliers);
  if (!essential) return planar_model(*homography);
  return scores_of(homography->model, essential->model, pairs).prefers_homography(config)
             ? planar_model(*homography)
             : general_model(essential->model, essential->inliers);
}

Result<TwoViewModel, NoStart> fundamental(const MatchedViews& views, const RayPairs& pairs,
                                          const InitializationConfig& config,
                                          core::Random& random) {
  const auto found = estimate_fundamental(pixel_pairs(views), ransac_options(config), random);
  if (!found) return refuse(no_model(pairs, config));
  const Eigen::Matrix3d essential = geometry::essential_from_fundamental(
      found->model, camera_of(views.first), camera_of(views.second));
  const auto homography = estimate_homography(pairs, ransac_options(config), random);
  if (homography) {
    const ModelScores scores = scores_of(homography->model, essential, pairs);
    if (scores.prefers_homography(config)) {
      return refuse(NoStart{
          StartRefusal::kDegenerate, pairs.size(),
          fmt::format("a homography has {:.2f} of both scores, expected at most {:.2f}: a plane or "
                      "a rotation does not fix the fundamental matrix",
                      scores.homography_ratio(), config.min_homography_ratio)});
    }
  }
  return general_model(essential, found->inliers);
}

}  // namespace

geometry::RayPairs ray_pairs(const MatchedViews& views) {
  const auto bearing = [](const View& view, int feature) {
    return geometry::bearing_of_undistorted(camera_of(view), undistorted_px(view, feature));
  };
  RayPairs pairs{{}, {}, geometry::focal_px(camera_of(views.first))};
  for (const auto& match : views.matches) {
    pairs.first.push_back(bearing(views.first, match.first));
    pairs.second.push_back(bearing(views.second, match.second));
  }
  return pairs;
}

Result<TwoViewModel, NoStart> estimate_model(const MatchedViews& views,
                                             const geometry::RayPairs& pairs,
                                             const InitializationConfig& config,
                                             core::Random& random) {
  return config.model == StartModel::kFundamental ? fundamental(views, pairs, config, random)
                                                  : homography_or_essential(pairs, config, random);
}

}  // namespace samewhere::track
