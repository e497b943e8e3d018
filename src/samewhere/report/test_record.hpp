#pragma once

// For the tests of this folder: a run through a made-up building.
#include <cmath>
#include <numbers>
#include <string>

#include <opencv2/imgproc.hpp>

#include <samewhere/core/random.hpp>
#include <samewhere/report/jpeg.hpp>
#include <samewhere/report/record.hpp>

namespace samewhere::report {

// Once round a rectangular corridor and a bit further, looking ahead; y points down.
inline core::Rigid3 corridor_pose(double travelled_m) {
  const double length_m = 20.0;
  const double width_m = 8.0;
  double s = std::fmod(travelled_m, 2.0 * (length_m + width_m));
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();
  double heading_rad = 0.5 * std::numbers::pi;
  for (const double side_m : {length_m, width_m, length_m, width_m}) {
    const double part_m = std::min(s, side_m);
    position += part_m * direction;
    s -= part_m;
    if (s <= 0.0) break;
    direction = Eigen::Vector3d(-direction.z(), 0.0, direction.x());
    heading_rad -= 0.5 * std::numbers::pi;
  }
  return {core::exp_so3({0.0, heading_rad, 0.0}), position};
}

inline cv::Mat corridor_picture(int index) {
  cv::Mat picture(240, 320, CV_8UC3, cv::Scalar(150, 160, 165));
  const cv::Point middle(160 + index % 7 * 4, 110);
  const cv::Scalar wall(120 + index % 5 * 12, 135, 140);
  cv::fillConvexPoly(picture, std::vector<cv::Point>{{0, 0}, middle, {0, 239}}, wall);
  cv::fillConvexPoly(picture, std::vector<cv::Point>{{319, 0}, middle, {319, 239}}, wall);
  cv::fillConvexPoly(picture, std::vector<cv::Point>{{0, 239}, middle, {319, 239}},
                     cv::Scalar(90, 95, 105));
  cv::rectangle(picture, {40, 80, 34, 110}, cv::Scalar(60, 80, 120), cv::FILLED);
  cv::rectangle(picture, {250, 70, 36, 125}, cv::Scalar(70, 110, 60), cv::FILLED);
  return picture;
}

inline core::Evidence evidence(double similarity, int num_matches, int num_inliers) {
  core::Evidence result;
  result.similarity = similarity;
  if (num_matches == 0) return result;
  core::GeometryEvidence geometry;
  geometry.num_matches = num_matches;
  geometry.num_inliers = num_inliers;
  geometry.inlier_ratio = static_cast<double>(num_inliers) / num_matches;
  geometry.spread_ratio = 0.25;
  geometry.overlap_ratio = 0.75;
  geometry.reprojection_rmse_px = 1.25;
  geometry.match_from_query = core::Sim3{1.0, core::exp_so3({0.0, 0.1, 0.0}), {0.1, 0.0, 0.3}};
  result.geometry = geometry;
  return result;
}

inline core::Candidate candidate(int id, int query, int match, double similarity) {
  return {core::CandidateId(static_cast<std::uint64_t>(id)),
          core::FrameId(static_cast<std::uint64_t>(query)),
          core::FrameId(static_cast<std::uint64_t>(match)), similarity};
}

inline core::LedgerRow loop_row(const core::Candidate& candidate, int num_inliers) {
  core::LoopClosure loop;
  loop.candidate = candidate.id;
  loop.evidence = evidence(candidate.similarity, 2 * num_inliers, num_inliers);
  loop.evidence.odometry = core::OdometryEvidence{0.4, 0.02, 3.5};
  loop.match_from_query = loop.evidence.geometry->match_from_query;
  return {candidate, loop};
}

inline core::LedgerRow refused_row(const core::Candidate& candidate, core::Refusal stage,
                                   const core::Evidence& evidence, const std::string& reason) {
  core::Rejection rejection;
  rejection.candidate = candidate.id;
  rejection.evidence = evidence;
  rejection.stage = stage;
  rejection.reason = reason;
  return {candidate, rejection};
}

inline core::LedgerRow ambiguous_row(const core::Candidate& candidate) {
  core::Ambiguous ambiguous;
  ambiguous.candidate = candidate.id;
  ambiguous.evidence = evidence(candidate.similarity, 120, 44);
  ambiguous.reason = "two corridors explain the view equally well: 44 and 41 inliers";
  return {candidate, ambiguous};
}

// 3 loops, 1 undecided (first refused), and of the refused 20 at similarity, 6 at matches, 4 at
// inliers, 1 at the odometry. All views are between frames 270 to 310 and 0 to 40.
inline core::Ledger sample_ledger() {
  core::Ledger ledger;
  int id = 0;
  for (int i = 0; i < 20; ++i, ++id)
    ledger.push_back(refused_row(candidate(id, 270 + i, i, 0.4 + 0.01 * i),
                                 core::Refusal::kSimilarity, evidence(0.4 + 0.01 * i, 0, 0),
                                 "similarity is below 0.700"));
  for (int i = 0; i < 6; ++i, ++id)
    ledger.push_back(refused_row(candidate(id, 285 + i, 3 * i, 0.72), core::Refusal::kMatches,
                                 evidence(0.72, 14 + i, 0), "14 matches, at least 20 are needed"));
  for (int i = 0; i < 4; ++i, ++id)
    ledger.push_back(refused_row(candidate(id, 290 + i, 20 + i, 0.76), core::Refusal::kInliers,
                                 evidence(0.76, 60, 12 + i), "12 inliers, at least 30 are needed"));
  const core::Candidate waiting = candidate(id++, 300, 2, 0.81);
  ledger.push_back(
      refused_row(waiting, core::Refusal::kSpread, evidence(0.81, 120, 44), "too narrow"));
  ledger.push_back(
      refused_row(candidate(id++, 301, 25, 0.84), core::Refusal::kOdometry, evidence(0.84, 140, 71),
                  "the loop would move the query by 9.8 m, the accumulated drift allows "
                  "1.2 m: a corridor that looks the same"));
  for (int i = 0; i < 3; ++i, ++id)
    ledger.push_back(loop_row(candidate(id, 305 + i, 24 + i, 0.9), 80 + i));
  ledger.push_back(ambiguous_row(waiting));
  return ledger;
}

inline FrameRecord frame_record(int index, const std::optional<core::Rigid3>& world_from_camera) {
  FrameRecord frame;
  frame.pose.frame = core::FrameId(static_cast<std::uint64_t>(index));
  frame.pose.stamp_s = index / 10.0;
  frame.pose.status = index < 5           ? core::FrameStatus::kStarting
                      : world_from_camera ? core::FrameStatus::kTracking
                                          : core::FrameStatus::kLost;
  frame.pose.is_measured = world_from_camera.has_value();
  frame.pose.num_inliers = world_from_camera ? 120 : 0;
  frame.pose.reference_keyframe = core::KeyframeId(static_cast<std::uint64_t>(index / 10));
  frame.name = "corridor_" + std::to_string(index) + ".png";
  frame.world_from_camera = world_from_camera;
  return frame;
}

inline RunRecord sample_record() {
  RunRecord record;
  record.title = "Round the corridor";
  record.source = "a made-up building, seed 3";
  core::Random random(3);
  core::Vector6d drift = core::Vector6d::Zero();
  for (int i = 0; i < 320; ++i) {
    const core::Rigid3 truth = corridor_pose(0.2 * i);
    core::Rigid3 estimate = truth;
    estimate.translation += 0.03 * Eigen::Vector3d(random.gaussian(), 0.0, random.gaussian());
    drift += core::Vector6d{0.004, 0.0, 0.003, 0.0, 0.0007, 0.0};
    const bool is_lost = i >= 150 && i < 158;
    record.truth.push_back({i / 10.0, truth});
    record.odometry.push_back({i / 10.0, core::exp_r3so3(drift) * truth});
    record.frames.push_back(
        frame_record(i, is_lost ? std::nullopt : std::optional<core::Rigid3>(estimate)));
  }
  record.frames[158].pose.status = core::FrameStatus::kResumed;
  for (int i = 200; i < 215; ++i) record.frames[i].pose.status = core::FrameStatus::kWeak;
  record.ledger = sample_ledger();
  for (const core::LedgerRow& row : record.ledger)
    for (const core::FrameId frame : {row.candidate.query, row.candidate.match})
      record.thumbnails[frame] =
          jpeg_bytes(corridor_picture(static_cast<int>(frame.index())), kThumbnailWidth_px);
  record.points = {{{1.0f, 2.0f, 3.0f}, {255, 128, 0}}, {{-1.0f, 0.5f, 0.0f}, {1, 2, 3}}};
  record.figures = {{"frames with a measured pose", "312 of 320"},
                    {"ATE RMSE", "0.042 m"},
                    {"ATE RMSE, odometry alone", "0.731 m"},
                    {"rotational error over 1 s, median", "0.31 degrees"},
                    {"loops accepted, right / wrong", "3 / 0"},
                    {"keyframes", "32"}};
  record.config_yaml = "verify:\n  min_inliers: 30\n";
  record.timings.add(kWholeFrameStage, 10.0, 8.0);
  record.timings.add(kWholeFrameStage, 30.0, 16.0);
  record.timings.add("track", 8.0);
  return record;
}

}  // namespace samewhere::report
