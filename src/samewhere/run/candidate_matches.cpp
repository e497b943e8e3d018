#include <cmath>
#include <optional>

#include <samewhere/core/match_from_query.hpp>
#include <samewhere/features/match_pair.hpp>
#include <samewhere/geometry/camera.hpp>
#include <samewhere/report/pairs.hpp>
#include <samewhere/run/candidate_matches.hpp>
#include <samewhere/verify/decide.hpp>

namespace samewhere::run {
namespace {

// The two views of a candidate and the pose between them, if it has one.
struct PosedViews {
  const features::View& query;
  const features::View& match;
  std::optional<core::Sim3> query_from_match;  // bodies
};

bool is_explained(const PosedViews& views, const features::Match& found,
                  const pipeline::Config& config) {
  if (!views.query_from_match || !views.query.rig->is_calibrated()) return false;
  const auto in_match_camera = features::point_in_camera(views.match, found.first);
  if (!in_match_camera) return false;
  const Eigen::Vector3d in_query_body =
      *views.query_from_match * (views.match.rig->body_from_camera[0] * *in_match_camera);
  const auto projected = geometry::project_undistorted(
      views.query.rig->cameras[0],
      core::inverse(views.query.rig->body_from_camera[0]) * in_query_body);
  if (!projected) return false;
  const auto feature = static_cast<std::size_t>(found.second);
  const Eigen::Vector2d offset_px =
      *projected - views.query.features->undistorted_px[feature].cast<double>();
  // features of a higher pyramid level are less precise
  const double scale =
      std::pow(config.features.scale_factor, views.query.features->octave[feature]);
  return offset_px.norm() <= config.verify.max_error_px * scale;
}

Eigen::Vector2f share_of_image(const features::View& view, int feature) {
  const Eigen::Vector2f px = view.features->raw_px[static_cast<std::size_t>(feature)];
  return {px.x() / static_cast<float>(view.image_size_px.width),
          px.y() / static_cast<float>(view.image_size_px.height)};
}

std::vector<report::ImageMatch> matches_of(const PosedViews& views,
                                           const pipeline::Config& config) {
  std::vector<report::ImageMatch> matches;
  // in this order, as the verifier does: the ratio test depends on it
  for (const features::Match& found : features::match_pair(
           views.match.features->descriptors, views.query.features->descriptors, config.features)) {
    matches.push_back({share_of_image(views.query, found.second),
                       share_of_image(views.match, found.first),
                       is_explained(views, found, config)});
  }
  return matches;
}

std::optional<core::Sim3> query_from_match_of(const core::Verdict& verdict) {
  const std::optional<core::Sim3> match_from_query = core::match_from_query_of(verdict);
  return match_from_query ? std::optional(core::inverse(*match_from_query)) : std::nullopt;
}

}  // namespace

std::map<core::CandidateId, std::vector<report::ImageMatch>> candidate_matches(
    const core::Ledger& ledger, const scene::MapVersion& map, const pipeline::Config& config,
    std::size_t max_candidates) {
  std::vector<const core::LedgerRow*> rows = report::accepted_rows(ledger);
  const std::vector<const core::LedgerRow*> others = report::rejected_rows(ledger);
  rows.insert(rows.end(), others.begin(), others.end());
  std::map<core::CandidateId, std::vector<report::ImageMatch>> matches;
  for (const core::LedgerRow* row : rows) {
    if (matches.size() >= max_candidates) break;
    const scene::Keyframe* query = scene::keyframe_of(map, row->candidate.query);
    const scene::Keyframe* match = scene::keyframe_of(map, row->candidate.match);
    if (query == nullptr || match == nullptr) continue;
    matches[row->candidate.id] =
        matches_of({query->view, match->view, query_from_match_of(row->verdict)}, config);
  }
  return matches;
}

std::vector<report::ScoreLimit> score_limits(const verify::Config& config) {
  const bool is_sequence = verify::needs_sequences(config);
  std::vector<report::ScoreLimit> limits = {
      {"similarity", "verify.min_similarity", true, config.min_similarity}};
  if (config.require_geometry) {
    limits.push_back({"num_matches", "verify.min_matches", true, double(config.min_matches)});
    limits.push_back(is_sequence
                         ? report::ScoreLimit{"num_inliers", "verify.min_inliers_in_sequence", true,
                                              double(config.min_inliers_in_sequence)}
                         : report::ScoreLimit{"num_inliers", "verify.min_inliers", true,
                                              double(config.min_inliers)});
    if (!is_sequence)
      limits.push_back({"spread_ratio", "verify.min_spread_ratio", true, config.min_spread_ratio});
    limits.push_back(
        {"pose_difference_m", "verify.max_pose_difference_m", false, config.max_pose_difference_m});
    limits.push_back({"pose_difference_rad", "verify.max_pose_difference_rad", false,
                      config.max_pose_difference_rad});
  }
  if (config.method == verify::Method::kDeformation) {
    limits.push_back({"deformation_rmse_m", "verify.max_deformation_ratio", false,
                      config.max_deformation_ratio, "deformation_path_m"});
    return limits;
  }
  limits.push_back({"mahalanobis_squared", "verify.max_odometry_chi_square", false,
                    config.max_odometry_chi_square});
  for (const char* score : {"mahalanobis_squared_with_loops", "competing_loop_mahalanobis_squared"})
    limits.push_back(
        {score, "verify.max_competing_chi_square", false, config.max_competing_chi_square});
  limits.push_back(
      {"competing_loop_gain", "verify.min_competing_gain", true, config.min_competing_gain});
  limits.push_back({"competing_place_inliers", "verify.max_competing_place_ratio", false,
                    config.max_competing_place_ratio, "num_inliers"});
  if (is_sequence)
    limits.push_back({"num_sequence_views", "verify.min_views", true, double(config.min_views)});
  if (config.prior == verify::Prior::kRepetitive)
    limits.push_back(
        {"look_alike_gain", "verify.min_look_alike_gain", true, config.min_look_alike_gain});
  return limits;
}

}  // namespace samewhere::run
