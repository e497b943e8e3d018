#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include <samewhere/core/ids.hpp>
#include <samewhere/core/rigid3.hpp>

namespace samewhere::core {

// Two views that look alike, found by appearance only, or by what their features vote for, or,
// foretold, because the views before them or beside them matched: neither of these two may prove a
// sequence, for they were looked for because they fit. Of a lost view: if the judge accepts it, it
// is a place where the view may have been taken, and no loop.
struct Candidate {
  CandidateId id;
  FrameId query;
  FrameId match;            // older than query
  double similarity = 0.0;  // of the two descriptors, in [-1, 1]
  bool is_foretold = false;
  bool is_lost = false;
  bool is_by_features = false;
};

// What geometry says about a candidate.
struct GeometryEvidence {
  int num_matches = 0;  // feature matches offered to RANSAC
  // With a pose: matches that were searched again where it projects the points, often more. 0: were
  // not.
  int num_guided_matches = 0;
  // Of the matches of the last stage, consistent with one relative pose (or fundamental matrix).
  int num_inliers = 0;
  double inlier_ratio = 0.0;          // inliers among num_matches, over num_matches
  double spread_ratio = 0.0;          // share of the query image's 8 x 8 cells that hold an inlier
  double overlap_ratio = 0.0;         // of either picture about so much lies in the other
  double reprojection_rmse_px = 0.0;  // of the inliers
  // Body of the match from body of the query; none without depth.
  std::optional<Sim3> match_from_query;
  // How far the pose found from the query's depth is from that found from the match's depth; none
  // where only one of them has depth.
  std::optional<double> disagreement_m;
  std::optional<double> disagreement_rad;
};

// What the odometry since the match says about the relative pose that geometry found.
struct OdometryEvidence {
  double correction_m = 0.0;    // how far the loop moves the query
  double correction_rad = 0.0;  //
  // Of the correction under the drift model; chi-square with 6 degrees of freedom. Without depth,
  // of what is left of it once the scale has crept as the candidate says.
  double mahalanobis_squared = 0.0;
};

// The place where an earlier loop has put the query, and how far from there this one would put it.
struct RivalEvidence {
  FrameId frame;  // shows that place
  double apart_m = 0.0;
  double apart_rad = 0.0;
  double mahalanobis_squared = 0.0;  // under the drift since that loop; 6 degrees of freedom
  // Of the loops that contradict this one: the first, and how much likelier than that one odometry
  // makes this one (docs/decisions/023; twice a logarithm). Not measured if it cannot tell.
  CandidateId first_loop = {};
  std::optional<double> gain = {};
};

// Another place that the same view may show as well, and that the map knows to be another one: of
// these the one with most inliers.
struct OtherPlaceEvidence {
  FrameId frame;  // shows that place
  int num_inliers = 0;
  double apart_m = 0.0;  // how far it would put the query from where this place would
  double apart_rad = 0.0;
};

// What the views around the query say: whether they go on to match the views around the match.
// Views are counted by what they show, so a camera that stands still sees one.
struct SequenceEvidence {
  int query_view = 0;
  int match_view = 0;
  int num_views = 0;     // of the longest sequence through the candidate, as far as it is known
  int num_inliers = 0;   // of all of this sequence together
  bool is_over = false;  // has waited long enough
};

// Everything measured about one candidate. A part that was not measured is absent.
struct Evidence {
  double similarity = 0.0;
  std::optional<GeometryEvidence> geometry;
  std::optional<OdometryEvidence> odometry;
  std::optional<RivalEvidence> rival;
  std::optional<OtherPlaceEvidence> other_place;
  std::optional<SequenceEvidence> sequence;
};

// Where in the funnel a candidate was refused, in the order of the checks. kGraph: the judge had
// accepted it, but it does not go with odometry and the loops before it; kWithdrawn: nor with those
// after it.
enum class Refusal {
  kSimilarity,
  kPause,
  kMatches,
  kInliers,
  kSpread,
  kPose,
  kAgreement,
  kOdometry,
  kRival,
  kSequence,
  kGraph,
  kWithdrawn
};

inline constexpr Refusal kAllRefusals[] = {
    Refusal::kSimilarity, Refusal::kPause,    Refusal::kMatches,   Refusal::kInliers,
    Refusal::kSpread,     Refusal::kPose,     Refusal::kAgreement, Refusal::kOdometry,
    Refusal::kRival,      Refusal::kSequence, Refusal::kGraph,     Refusal::kWithdrawn};

std::string_view name_of(Refusal refusal);

// The two views show the same place.
struct LoopClosure {
  CandidateId candidate;
  Evidence evidence;
  std::optional<Sim3>
      match_from_query;  // none: counted as a loop, but adds no edge (profile paper without a pose)
  bool scale_is_free = false;  // monocular: the scale of match_from_query was estimated
  Matrix6d information = Matrix6d::Identity();  // of match_from_query, order [m; rad]
  bool is_by_hand = false;                      // a person said so, whatever the judge
  // Valid: that loop and those after it put the camera elsewhere, and odometry speaks against them.
  CandidateId overruled = {};
};

// The two views only look alike, or nothing proves that they do not.
struct Rejection {
  CandidateId candidate;
  Evidence evidence;
  Refusal stage = Refusal::kSimilarity;
  std::string reason;  // one sentence with the figure and the threshold
};

// Cannot tell, or not yet: the views that follow decide.
struct Ambiguous {
  CandidateId candidate;
  Evidence evidence;
  Refusal stage = Refusal::kSequence;  // the check that found no answer
  std::string reason;
};

using Verdict = std::variant<LoopClosure, Rejection, Ambiguous>;

const Evidence& evidence_of(const Verdict& verdict);
bool is_loop(const Verdict& verdict);
// "LOOP", "NOT" or "AMBIGUOUS": the words of loops.json.
std::string_view name_of(const Verdict& verdict);
// The check that decided, and why, in one sentence. For a loop: the last check, and what it
// measured.
std::string_view stage_of(const Verdict& verdict);
std::string reason_of(const Verdict& verdict);

}  // namespace samewhere::core
