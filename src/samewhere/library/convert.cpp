#include <Eigen/LU>

#include <samewhere/core/match_from_query.hpp>
#include <samewhere/core/verdict.hpp>
#include <samewhere/library/convert.hpp>

namespace samewhere::library {
namespace {

LoopScores scores_of(const core::Evidence& evidence) {
  LoopScores scores{.similarity = evidence.similarity};
  if (const auto& geometry = evidence.geometry) {
    scores.num_matches = geometry->num_matches;
    scores.num_inliers = geometry->num_inliers;
    scores.inlier_ratio = geometry->inlier_ratio;
    scores.overlap_ratio = geometry->overlap_ratio;
    scores.reprojection_rmse_px = geometry->reprojection_rmse_px;
  }
  if (const auto& odometry = evidence.odometry) {
    scores.correction_m = odometry->correction_m;
    scores.correction_rad = odometry->correction_rad;
    scores.odometry_chi_square = odometry->mahalanobis_squared;
    scores.sigma_m = odometry->sigma_m;
  }
  return scores;
}

LoopDecision decision_of(const core::Verdict& verdict) {
  if (core::is_loop(verdict)) return LoopDecision::kAccepted;
  if (std::holds_alternative<core::Ambiguous>(verdict)) return LoopDecision::kAmbiguous;
  const bool is_withdrawn = std::get<core::Rejection>(verdict).stage == core::Refusal::kWithdrawn;
  return is_withdrawn ? LoopDecision::kWithdrawn : LoopDecision::kRejected;
}

}  // namespace

Pose pose_of(const core::Rigid3& a_from_b) {
  Pose pose = Pose::Identity();
  pose.linear() = a_from_b.rotation.toRotationMatrix();
  pose.translation() = a_from_b.translation;
  return pose;
}

core::Rigid3 rigid_of(const Pose& a_from_b) {
  return {Eigen::Quaterniond(a_from_b.linear()).normalized(), a_from_b.translation()};
}

bool is_rigid(const Pose& a_from_b) {
  constexpr double kTolerance = 0.01;
  if (!a_from_b.matrix().allFinite()) return false;
  const Eigen::Matrix3d& rotation = a_from_b.linear();
  return (rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).norm() < kTolerance &&
         rotation.determinant() > 0.0;
}

Camera camera_of(const core::Camera& camera, int width_px, int height_px) {
  Camera found{.width_px = width_px, .height_px = height_px};
  const auto take = [&](const auto& c) {
    found.fx_px = c.fx_px;
    found.fy_px = c.fy_px;
    found.cx_px = c.cx_px;
    found.cy_px = c.cy_px;
  };
  std::visit(take, camera);
  if (const auto* fisheye = std::get_if<core::KannalaBrandt>(&camera)) {
    found.lens = Lens::kFisheye;
    found.distortion = {fisheye->k1, fisheye->k2, fisheye->k3, fisheye->k4};
  } else {
    const auto& c = std::get<core::PinholeRadtan>(camera);
    found.distortion = {c.k1, c.k2, c.p1, c.p2, c.k3, c.k4, c.k5, c.k6};
  }
  return found;
}

FrameKey key_of(core::FrameId frame) { return {frame.index(), frame.session()}; }

Status status_of(core::FrameStatus status) {
  if (is_waiting(status)) return Status::kInitializing;
  switch (status) {
    case core::FrameStatus::kWeak:
      return Status::kWeak;
    case core::FrameStatus::kLost:
      return Status::kLost;
    case core::FrameStatus::kProvisional:
      return Status::kProvisional;
    default:
      return Status::kTracking;
  }
}

LoopVerdict verdict_of(const core::LedgerRow& row) {
  LoopVerdict verdict{.candidate = row.candidate.id.value(),
                      .query = key_of(row.candidate.query),
                      .match = key_of(row.candidate.match),
                      .decision = decision_of(row.verdict),
                      .is_relocalization = row.candidate.origin == core::Origin::kRelocalization,
                      .check = std::string(core::stage_of(row.verdict)),
                      .reason = core::reason_of(row.verdict),
                      .scores = scores_of(core::evidence_of(row.verdict))};
  if (const auto pose = core::match_from_query_of(row.verdict)) {
    verdict.match_from_query = pose_of(rigid_part(*pose));
    verdict.scale = pose->scale;
  }
  const auto* loop = std::get_if<core::LoopClosure>(&row.verdict);
  if (loop != nullptr && loop->match_from_query) verdict.covariance = loop->information.inverse();
  return verdict;
}

pipeline::Config config_of(const std::string& profile, const std::vector<std::string>& settings,
                           std::optional<Prior> prior) {
  pipeline::Config config = pipeline::load_config(profile, {}, settings);
  if (prior) {
    config.verify.prior =
        *prior == Prior::kUnique ? verify::Prior::kUnique : verify::Prior::kRepetitive;
  }
  return config;
}

}  // namespace samewhere::library
