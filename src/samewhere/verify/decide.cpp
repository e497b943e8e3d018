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

// Views that share only a narrow or blurred part give a pose each, but not the same one.
std::optional<Rejection> check_consistency(const Candidate& candidate, const Evidence& evidence,
                                           const Config& config) {
  const double apart_m = evidence.geometry->pose_difference_m.value_or(0.0);
  const double apart_rad = evidence.geometry->pose_difference_rad.value_or(0.0);
  if (apart_m <= config.max_pose_difference_m && apart_rad <= config.max_pose_difference_rad) {
    return std::nullopt;
  }
  if (!std::isfinite(apart_m)) {
    return rejection(candidate, evidence, Refusal::kConsistency,
                     "only one of the two views gives a relative pose");
  }
  return rejection(candidate, evidence, Refusal::kConsistency,
                   fmt::format("the relative poses from the depth of each view differ by "
                               "{:.2f} m and {:.1f} degrees",
                               apart_m, apart_rad * kDegrees));
}

int inliers_needed(const Config& config) {
  return needs_sequences(config) ? config.min_inliers_in_sequence : config.min_inliers;
}

std::optional<Rejection> check_geometry(const Candidate& candidate, const Evidence& evidence,
                                        const Config& config) {
  const core::GeometryEvidence& g = *evidence.geometry;
  if (g.num_matches < config.min_matches) {
    return rejection(
        candidate, evidence, Refusal::kMatches,
        fmt::format("only {} feature matches, {} needed", g.num_matches, config.min_matches));
  }
  const bool is_by_itself = !needs_sequences(config);
  const int min_inliers = inliers_needed(config);
  if (g.num_inliers < min_inliers) {
    return rejection(
        candidate, evidence, Refusal::kInliers,
        fmt::format("only {} inliers of one geometry, {} needed", g.num_inliers, min_inliers));
  }
  if (is_by_itself && g.spread_ratio < config.min_spread_ratio) {
    return rejection(candidate, evidence, Refusal::kSpread,
                     fmt::format("the inliers cover {:.0f} % of the image, {:.0f} % needed",
                                 100.0 * g.spread_ratio, 100.0 * config.min_spread_ratio));
  }
  if (config.require_pose && !g.match_from_query) {
    return rejection(candidate, evidence, Refusal::kPose,
                     "no relative pose: too few inliers with known depth");
  }
  return check_consistency(candidate, evidence, config);
}

// Without depth: the scale drift that the candidate implies.
std::string scale_drift_text(const Evidence& evidence) {
  const auto& pose = evidence.geometry->match_from_query;
  if (!pose || pose->scale == 1.0) return "";
  return fmt::format(" with scale {:.2f}", pose->scale);
}

// By what the covariance of odometry was multiplied.
std::string variance_factor_text(const core::OdometryEvidence& odometry) {
  if (!odometry.variance_factor) return "";
  return fmt::format(", its variance times {:.2f} as closed loops show", *odometry.variance_factor);
}

std::optional<Rejection> check_odometry(const Candidate& candidate, const Evidence& evidence,
                                        const Config& config) {
  if (!evidence.odometry ||
      evidence.odometry->mahalanobis_squared <= config.max_odometry_chi_square)
    return std::nullopt;
  return rejection(
      candidate, evidence, Refusal::kOdometry,
      fmt::format("would move the camera by {:.2f} m and {:.1f} degrees{}, more than odometry can "
                  "have drifted (chi-square {:.0f}, at most {:.0f}{})",
                  evidence.odometry->correction_m, evidence.odometry->correction_rad * kDegrees,
                  scale_drift_text(evidence), evidence.odometry->mahalanobis_squared,
                  config.max_odometry_chi_square, variance_factor_text(*evidence.odometry)));
}

std::optional<Rejection> check_deformation(const Candidate& candidate, const Evidence& evidence,
                                           const Config& config) {
  if (!evidence.deformation) return std::nullopt;
  const auto& [rmse_m, path_m] = *evidence.deformation;
  if (rmse_m <= config.max_deformation_ratio * path_m) return std::nullopt;
  return rejection(
      candidate, evidence, Refusal::kDeformation,
      fmt::format("would move the keyframes since the match by {:.2f} m, {:.1f} % of "
                  "the way since then, at most {:.1f} %",
                  rmse_m, 100.0 * rmse_m / path_m, 100.0 * config.max_deformation_ratio));
}

// Odometry decides for the candidate, against the loops that it contradicts.
bool overrules(const core::CompetingLoopEvidence& loop, const Config& config) {
  return loop.mahalanobis_squared > config.max_competing_chi_square && loop.gain &&
         *loop.gain >= config.min_competing_gain;
}

// An earlier loop has put the query at another place. Odometry decides for that loop, or nothing
// does.
std::optional<core::Verdict> check_competing_loop(const Candidate& candidate,
                                                  const Evidence& evidence, const Config& config) {
  if (!evidence.competing_loop) return std::nullopt;
  const core::CompetingLoopEvidence& loop = *evidence.competing_loop;
  if (loop.mahalanobis_squared <= config.max_competing_chi_square || overrules(loop, config))
    return std::nullopt;
  const std::string reason = fmt::format(
      "the last loop places the camera at frame {}, {:.2f} m and {:.1f} degrees from here, "
      "more than odometry can have drifted since (chi-square {:.0f}, at most {:.0f})",
      loop.frame.index(), loop.apart_m, loop.apart_rad * kDegrees, loop.mahalanobis_squared,
      config.max_competing_chi_square);
  if (!loop.gain || *loop.gain > -config.min_competing_gain)
    return core::Ambiguous{candidate.id, evidence, Refusal::kCompeting, reason};
  return rejection(
      candidate, evidence, Refusal::kCompeting,
      fmt::format("{}; odometry fits that place better (gain {:.0f})", reason, *loop.gain));
}

// All loops of the map together put the query at another place.
std::optional<core::Verdict> check_loops_of_map(const Candidate& candidate,
                                                const Evidence& evidence, const Config& config) {
  if (!contradicts_loops(evidence, config)) return std::nullopt;
  if (evidence.competing_loop && overrules(*evidence.competing_loop, config)) return std::nullopt;
  return core::Ambiguous{
      candidate.id, evidence, Refusal::kCompeting,
      fmt::format("the loops of the map place the camera elsewhere, {:.2f} m and {:.1f} degrees "
                  "from here (chi-square {:.0f}, at most {:.0f})",
                  evidence.odometry->correction_m, evidence.odometry->correction_rad * kDegrees,
                  *evidence.odometry->mahalanobis_squared_with_loops,
                  config.max_competing_chi_square)};
}

// Another candidate of the query has about as many inliers at another place.
std::optional<core::Verdict> check_competing_place(const Candidate& candidate,
                                                   const Evidence& evidence, const Config& config) {
  if (!evidence.competing_place) return std::nullopt;
  // the other candidate may agree with the loops that odometry rejects
  if (evidence.competing_loop && overrules(*evidence.competing_loop, config)) return std::nullopt;
  const core::CompetingPlaceEvidence& place = *evidence.competing_place;
  const int num_inliers = evidence.geometry->num_inliers;
  if (place.num_inliers <= config.max_competing_place_ratio * num_inliers) return std::nullopt;
  return core::Ambiguous{
      candidate.id, evidence, Refusal::kCompeting,
      fmt::format(
          "frame {} shows another place, {:.2f} m and {:.1f} degrees from here, with {} inliers; "
          "at most {:.0f} % of the {} here",
          place.frame.index(), place.apart_m, place.apart_rad * kDegrees, place.num_inliers,
          100.0 * config.max_competing_place_ratio, num_inliers)};
}

// So many inliers that no other view has to match.
bool is_sure_alone(const core::GeometryEvidence& geometry, const Config& config) {
  return geometry.num_inliers >= config.min_inliers &&
         geometry.spread_ratio >= config.min_spread_ratio;
}

// Pending, or rejected after max_pending_views.
std::optional<core::Verdict> check_sequence(const Candidate& candidate, const Evidence& evidence,
                                            const Config& config) {
  const core::SequenceEvidence sequence = evidence.sequence.value_or(core::SequenceEvidence{});
  if (sequence.num_views >= config.min_views) return std::nullopt;
  if (sequence.is_over) {
    if (is_sure_alone(*evidence.geometry, config)) return std::nullopt;
    return rejection(candidate, evidence, Refusal::kSequence,
                     fmt::format("only {} consecutive views match, {} needed, or {} inliers",
                                 sequence.num_views, config.min_views, config.min_inliers));
  }
  return core::Ambiguous{candidate.id, evidence, Refusal::kSequence,
                         fmt::format("{} consecutive views match so far, {} needed: pending",
                                     sequence.num_views, config.min_views)};
}

// Motion between the visits is the only evidence that a look-alike place would not give as well.
std::optional<core::Verdict> check_evidence(const Candidate& candidate, const Evidence& evidence,
                                            const Config& config) {
  if (config.prior == Prior::kUnique) return std::nullopt;
  const auto ambiguous = [&](std::string reason) {
    return core::Ambiguous{candidate.id, evidence, Refusal::kEvidence, std::move(reason)};
  };
  const core::OdometryEvidence odometry = evidence.odometry.value_or(core::OdometryEvidence{});
  // of none or less, the other
  const auto gain = std::max(odometry.look_alike_gain, odometry.look_alike_gain_with_loops);
  if (!gain) return ambiguous("appearance alone: cannot be told from a look-alike place");
  if (*gain >= config.min_look_alike_gain) return std::nullopt;
  return ambiguous(fmt::format(
      "odometry is too uncertain (standard deviation {:.2f} m{}) to tell this place from a "
      "look-alike place nearby (gain {:.1f}, {:.1f} needed)",
      odometry.sigma_m.value_or(0.0), variance_factor_text(odometry), *gain,
      config.min_look_alike_gain));
}

std::optional<core::Verdict> check_other_views(const Candidate& candidate, const Evidence& evidence,
                                               const Config& config) {
  auto undecided = check_competing_loop(candidate, evidence, config);
  if (!undecided) undecided = check_loops_of_map(candidate, evidence, config);
  if (!undecided) undecided = check_competing_place(candidate, evidence, config);
  if (!undecided && needs_sequences(config))
    undecided = check_sequence(candidate, evidence, config);
  if (!undecided) undecided = check_evidence(candidate, evidence, config);
  return undecided;
}

// The first check of geometry, motion and other views that fails.
std::optional<core::Verdict> failed_check(const Candidate& candidate, const Evidence& evidence,
                                          const Config& config) {
  if (const auto refused = check_geometry(candidate, evidence, config)) return *refused;
  if (config.method == Method::kDeformation && evidence.deformation) {
    const auto refused = check_deformation(candidate, evidence, config);
    return refused ? std::optional<core::Verdict>(*refused) : std::nullopt;
  }
  if (const auto refused = check_odometry(candidate, evidence, config)) return *refused;
  return check_other_views(candidate, evidence, config);
}

// A similarity, mapped into [0, 1).
double below_1(double similarity) { return 0.499 * (1.0 + similarity); }

// How many inliers a view that is no part of a sequence needs beyond one that is.
int more_if_alone(const Config& config) {
  return std::max(0, config.min_inliers - inliers_needed(config));
}

// The loop's edge, and the loop that it overrules.
void add_edge(core::LoopClosure& loop, const Config& config) {
  loop.match_from_query = loop.evidence.geometry->match_from_query;
  const auto& competing = loop.evidence.competing_loop;
  if (competing && overrules(*competing, config)) loop.overruled = competing->first_loop;
}

}  // namespace

bool needs_sequences(const Config& config) {
  return config.require_geometry && !config.require_pose && config.min_views > 1;
}

bool is_pending(const core::Verdict& verdict) {
  const auto* ambiguous = std::get_if<core::Ambiguous>(&verdict);
  return ambiguous != nullptr && ambiguous->stage == Refusal::kSequence;
}

bool has_geometry(const Evidence& evidence, const Config& config) {
  return evidence.geometry && !check_geometry({}, evidence, config);
}

bool contradicts_loops(const Evidence& evidence, const Config& config) {
  const auto& odometry = evidence.odometry;
  return odometry && odometry->mahalanobis_squared_with_loops &&
         *odometry->mahalanobis_squared_with_loops > config.max_competing_chi_square;
}

bool is_recognized(const core::Verdict& verdict) {
  const auto* ambiguous = std::get_if<core::Ambiguous>(&verdict);
  return core::is_loop(verdict) || (ambiguous != nullptr && ambiguous->stage == Refusal::kEvidence);
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
  const auto failed = failed_check(candidate, evidence, config);
  // without required geometry a pose is used if it is good, and the loop is counted without one if
  // not
  if (failed && config.require_geometry) return *failed;
  if (!failed) add_edge(loop, config);
  // with depth it is 1, not about 1
  loop.scale_is_free = loop.match_from_query && loop.match_from_query->scale != 1.0;
  return loop;
}

double rank(const Evidence& evidence, const Config& config) {
  if (config.rank_by == RankBy::kSimilarity) return evidence.similarity;
  const core::GeometryEvidence geometry = evidence.geometry.value_or(core::GeometryEvidence{});
  const double ties = kTie * (geometry.num_inliers + below_1(evidence.similarity));
  if (geometry.num_inliers < inliers_needed(config)) return ties;
  return ties + geometry.num_inliers * geometry.overlap_ratio * geometry.overlap_ratio;
}

double score(const Evidence& evidence, const Config& config) {
  if (config.rank_by == RankBy::kSimilarity) return evidence.similarity;
  const double ties = below_1(evidence.similarity);
  if (evidence.sequence && evidence.sequence->num_views >= std::max(2, config.min_views))
    return ties +
           static_cast<double>(evidence.sequence->num_inliers) / evidence.sequence->num_views;
  const int num_inliers = evidence.geometry ? evidence.geometry->num_inliers : 0;
  return ties + std::max(0, num_inliers - more_if_alone(config));
}

}  // namespace samewhere::verify
