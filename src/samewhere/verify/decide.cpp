#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include <samewhere/verify/decide.hpp>
#include <samewhere/verify/measure_odometry.hpp>

namespace samewhere::verify {
namespace {

using core::Candidate;
using core::Evidence;
using core::Refusal;
using core::Rejection;

constexpr double kTie = 1e-3;
constexpr double kDegrees = 180.0 / std::numbers::pi;

Rejection rejection(const Candidate& candidate, const Evidence& evidence, Refusal stage,
                    std::string reason) {
  return {candidate.id, evidence, stage, std::move(reason)};
}

// Views that share only a narrow or blurred part find a pose each, but not the same one.
std::optional<Rejection> check_agreement(const Candidate& candidate, const Evidence& evidence,
                                         const Config& config) {
  const double apart_m = evidence.geometry->disagreement_m.value_or(0.0);
  const double apart_rad = evidence.geometry->disagreement_rad.value_or(0.0);
  if (apart_m <= config.max_pose_difference_m && apart_rad <= config.max_pose_difference_rad) {
    return std::nullopt;
  }
  if (!std::isfinite(apart_m)) {
    return rejection(candidate, evidence, Refusal::kAgreement,
                     "only one of the two views finds a relative pose");
  }
  return rejection(candidate, evidence, Refusal::kAgreement,
                   fmt::format("the relative poses found from each of the two views differ by "
                               "{:.2f} m and {:.1f} degrees",
                               apart_m, apart_rad * kDegrees));
}

int inliers_needed(const core::GeometryEvidence& geometry, const Config& config) {
  return needs_sequence(geometry, config) ? config.min_inliers_in_sequence : config.min_inliers;
}

std::optional<Rejection> check_geometry(const Candidate& candidate, const Evidence& evidence,
                                        const Config& config) {
  const core::GeometryEvidence& g = *evidence.geometry;
  if (g.num_matches < config.min_matches) {
    return rejection(
        candidate, evidence, Refusal::kMatches,
        fmt::format("only {} feature matches, {} needed", g.num_matches, config.min_matches));
  }
  const bool is_for_itself = !needs_sequence(g, config);
  const int min_inliers = inliers_needed(g, config);
  if (g.num_inliers < min_inliers) {
    return rejection(candidate, evidence, Refusal::kInliers,
                     fmt::format("only {} features agree on one geometry, {} needed", g.num_inliers,
                                 min_inliers));
  }
  if (is_for_itself && g.spread_ratio < config.min_spread_ratio) {
    return rejection(
        candidate, evidence, Refusal::kSpread,
        fmt::format("the features that agree cover {:.0f} % of the picture, {:.0f} % needed",
                    100.0 * g.spread_ratio, 100.0 * config.min_spread_ratio));
  }
  if (config.require_pose && !g.match_from_query) {
    return rejection(candidate, evidence, Refusal::kPose,
                     "no relative pose: too few of the features that agree have a known depth");
  }
  return check_agreement(candidate, evidence, config);
}

// Without depth: what the scale would have to have done.
std::string crept(const Evidence& evidence) {
  const auto& pose = evidence.geometry->match_from_query;
  if (!pose || pose->scale == 1.0) return "";
  return fmt::format(", and what is 1 long to be {:.2f} long", pose->scale);
}

std::optional<Rejection> check_odometry(const Candidate& candidate, const Evidence& evidence,
                                        const Config& config) {
  if (!evidence.odometry ||
      evidence.odometry->mahalanobis_squared <= config.max_odometry_chi_square)
    return std::nullopt;
  return rejection(
      candidate, evidence, Refusal::kOdometry,
      fmt::format("would move the camera by {:.2f} m and {:.1f} degrees{}, more than odometry can "
                  "have drifted (chi-square {:.0f}, at most {:.0f})",
                  evidence.odometry->correction_m, evidence.odometry->correction_rad * kDegrees,
                  crept(evidence), evidence.odometry->mahalanobis_squared,
                  config.max_odometry_chi_square));
}

// Odometry can tell.
bool overrules(const core::RivalEvidence& rival, const Config& config) {
  return rival.mahalanobis_squared > config.max_competing_chi_square && rival.gain &&
         *rival.gain >= config.min_competing_gain;
}

// Two places that explain the view: nobody can tell which.
std::optional<core::Verdict> check_rival(const Candidate& candidate, const Evidence& evidence,
                                         const Config& config) {
  if (!evidence.rival) return std::nullopt;
  const core::RivalEvidence& rival = *evidence.rival;
  if (rival.mahalanobis_squared <= config.max_competing_chi_square || overrules(rival, config))
    return std::nullopt;
  return core::Ambiguous{
      candidate.id, evidence, Refusal::kRival,
      fmt::format(
          "the last loop has put the camera where frame {} was taken, {:.2f} m and {:.1f} "
          "degrees from here, more than odometry can have drifted since (chi-square {:.0f}, "
          "at most {:.0f})",
          rival.frame.index(), rival.apart_m, rival.apart_rad * kDegrees, rival.mahalanobis_squared,
          config.max_competing_chi_square)};
}

// Two places that explain the view about as well.
std::optional<core::Verdict> check_other_place(const Candidate& candidate, const Evidence& evidence,
                                               const Config& config) {
  if (!evidence.other_place) return std::nullopt;
  // the other one may go with the loops that odometry speaks against
  if (evidence.rival && overrules(*evidence.rival, config)) return std::nullopt;
  const core::OtherPlaceEvidence& other = *evidence.other_place;
  const int num_inliers = evidence.geometry->num_inliers;
  if (other.num_inliers <= config.max_competing_place_ratio * num_inliers) return std::nullopt;
  return core::Ambiguous{
      candidate.id, evidence, Refusal::kRival,
      fmt::format("frame {} shows another place, {:.2f} m and {:.1f} degrees from here, with which "
                  "{} features agree; at most {:.0f} % of the {} that agree here",
                  other.frame.index(), other.apart_m, other.apart_rad * kDegrees, other.num_inliers,
                  100.0 * config.max_competing_place_ratio, num_inliers)};
}

// Not a loop yet, or never.
std::optional<core::Verdict> check_sequence(const Candidate& candidate, const Evidence& evidence,
                                            const Config& config) {
  const core::SequenceEvidence sequence = evidence.sequence.value_or(core::SequenceEvidence{});
  if (sequence.num_views >= config.min_views) return std::nullopt;
  if (sequence.is_over) {
    return rejection(candidate, evidence, Refusal::kSequence,
                     fmt::format("only {} views in a row go on to match, {} needed",
                                 sequence.num_views, config.min_views));
  }
  return core::Ambiguous{
      candidate.id, evidence, Refusal::kSequence,
      fmt::format("{} views in a row go on to match so far, {} needed: waits for those that follow",
                  sequence.num_views, config.min_views)};
}

std::optional<core::Verdict> check_other_views(const Candidate& candidate, const Evidence& evidence,
                                               const Config& config) {
  auto undecided = check_rival(candidate, evidence, config);
  if (!undecided) undecided = check_other_place(candidate, evidence, config);
  if (!undecided && needs_sequence(*evidence.geometry, config))
    undecided = check_sequence(candidate, evidence, config);
  return undecided;
}

// A similarity, mapped into [0, 1).
double below_1(double similarity) { return 0.499 * (1.0 + similarity); }

// With its pose, and against whom it contradicts.
void join(core::LoopClosure& loop, const Config& config) {
  loop.match_from_query = loop.evidence.geometry->match_from_query;
  const auto& rival = loop.evidence.rival;
  if (rival && overrules(*rival, config)) loop.overruled = rival->first_loop;
}

}  // namespace

bool may_need_sequences(const Config& config) {
  return config.require_geometry && !config.require_pose && config.min_views > 1;
}

bool needs_sequence(const core::GeometryEvidence& geometry, const Config& config) {
  return may_need_sequences(config) && !geometry.match_from_query;
}

std::optional<Rejection> refuse_early(const Candidate& candidate, const Evidence& evidence,
                                      const History& history, const Config& config) {
  if (evidence.similarity <= config.min_similarity) {
    return rejection(candidate, evidence, Refusal::kSimilarity,
                     fmt::format("similarity {:.3f}, more than {:.3f} needed", evidence.similarity,
                                 config.min_similarity));
  }
  if (!history.last_loop_query || config.pause_frames == 0) return std::nullopt;
  const auto since = candidate.query.index() - history.last_loop_query->index();
  if (since > static_cast<std::uint64_t>(config.pause_frames)) return std::nullopt;
  if (since == 0) {
    return rejection(candidate, evidence, Refusal::kPause,
                     "another match of this view is a loop, detection pauses");
  }
  return rejection(
      candidate, evidence, Refusal::kPause,
      fmt::format("{} frames after a loop, detection pauses for {}", since, config.pause_frames));
}

core::Verdict decide(const Candidate& candidate, const Evidence& evidence, const History& history,
                     const Config& config) {
  if (auto refused = refuse_early(candidate, evidence, history, config)) return *refused;
  core::LoopClosure loop;
  loop.candidate = candidate.id;
  loop.evidence = evidence;
  loop.information = loop_information(config);
  if (!evidence.geometry) {
    if (!config.require_geometry) return loop;
    return rejection(candidate, evidence, Refusal::kMatches, "geometry was not measured");
  }
  auto refused = check_geometry(candidate, evidence, config);
  if (!refused) refused = check_odometry(candidate, evidence, config);
  if (refused && config.require_geometry) return *refused;
  // without required geometry a pose is used if it is good, and the loop is counted without one if
  // not
  if (!refused) {
    const auto undecided = check_other_views(candidate, evidence, config);
    if (undecided && config.require_geometry) return *undecided;
    if (!undecided) join(loop, config);
  }
  // with depth it is 1, not about 1
  loop.scale_is_free = loop.match_from_query && loop.match_from_query->scale != 1.0;
  return loop;
}

double rank(const Evidence& evidence, const Config& config) {
  if (config.rank_by == RankBy::kSimilarity) return evidence.similarity;
  const core::GeometryEvidence geometry = evidence.geometry.value_or(core::GeometryEvidence{});
  const double ties = kTie * (geometry.num_inliers + below_1(evidence.similarity));
  if (geometry.num_inliers < inliers_needed(geometry, config)) return ties;
  return ties + geometry.num_inliers * geometry.overlap_ratio * geometry.overlap_ratio;
}

double score(const Evidence& evidence, const Config& config) {
  if (config.rank_by == RankBy::kSimilarity) return evidence.similarity;
  const int alone = evidence.geometry ? evidence.geometry->num_inliers : 0;
  const int in_sequence = evidence.sequence ? evidence.sequence->num_inliers : 0;
  return std::max(alone, in_sequence) + below_1(evidence.similarity);
}

}  // namespace samewhere::verify
