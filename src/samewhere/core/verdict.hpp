#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include <samewhere/core/ids.hpp>
#include <samewhere/core/rigid3.hpp>

namespace samewhere::core {

// How a candidate was proposed.
enum class Origin {
  kRetrieved,      // by the similarity of the global descriptors
  kVisualWords,    // by the bag of visual words
  kNeighbour,      // near the best match of the same query; no evidence for a sequence
  kPredicted,      // the next pair of a sequence; no evidence for this sequence
  kRelocalization  // retrieved for the view of a LOST frame: an accepted one is a place, not a loop
};

inline constexpr Origin kAllOrigins[] = {Origin::kRetrieved, Origin::kVisualWords,
                                         Origin::kNeighbour, Origin::kPredicted,
                                         Origin::kRelocalization};

// "retrieved", "visual words", "neighbour", "predicted" or "relocalization": as in loops.json.
std::string_view name_of(Origin origin);

// Two views that may show the same place.
struct Candidate {
  CandidateId id;
  FrameId query;
  FrameId match;            // older than query
  double similarity = 0.0;  // of the two descriptors, in [-1, 1]
  Origin origin = Origin::kRetrieved;
};

// Geometric verification of a candidate.
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
  // Pose consistency: the pose from the query's depth against that from the match's depth; none
  // where only one of them has depth.
  std::optional<double> pose_difference_m;
  std::optional<double> pose_difference_rad;
};

// Odometry gate: the correction that the candidate's relative pose asks for.
struct OdometryEvidence {
  double correction_m = 0.0;    // of the query's position
  double correction_rad = 0.0;  // of its rotation
  // Of the correction under the accumulated drift since the match; chi-square with 6 degrees of
  // freedom. Without depth the scale drift that the candidate implies is taken out first.
  double mahalanobis_squared = 0.0;
  // Standard deviation of the query's position relative to the match, in its least certain
  // direction. Without depth in units of the map. None: odometry does not join the two.
  std::optional<double> sigma_m;
  // Log-likelihood ratio, times two, of this place over the most likely look-alike place that is at
  // least verify.min_look_alike_distance_m away, under odometry. None as before.
  std::optional<double> look_alike_gain;
  // The same, and the Mahalanobis distance, under odometry and the loops closed so far. None
  // without loops.
  std::optional<double> look_alike_gain_with_loops;
  std::optional<double> mahalanobis_squared_with_loops;
  // The loops closed so far show that the covariance of odometry is too large: what it was
  // multiplied by. None: nothing was learned.
  std::optional<double> variance_factor;
};

// How much the candidate bends the trajectory from its match to its query: root mean square
// displacement of the keyframes when it is added to the pose graph, after rigid alignment, and the
// length of that stretch of the trajectory.
struct DeformationEvidence {
  double rmse_m = 0.0;
  double path_m = 0.0;
};

// Competing hypothesis of an earlier loop: where it has put the query, and how far from there this
// candidate would put it.
struct CompetingLoopEvidence {
  FrameId frame;  // the match of that loop
  double apart_m = 0.0;
  double apart_rad = 0.0;
  double mahalanobis_squared = 0.0;  // under the drift since that loop; 6 degrees of freedom
  // The first of the loops that contradict this candidate, and the log-likelihood ratio of the
  // candidate over it, times two, under odometry (docs/decisions/023). Empty where it was not
  // measured.
  CandidateId first_loop = {};
  std::optional<double> gain = {};
};

// Competing hypothesis of the same query: of its candidates at another place that pass all checks
// the one with most inliers.
struct CompetingPlaceEvidence {
  FrameId frame;  // the match of that candidate
  int num_inliers = 0;
  double apart_m = 0.0;  // between the query's poses by both candidates
  double apart_rad = 0.0;
};

// Sequence of views around the candidate, whose queries match the views around its match. Views are
// counted by their content: a camera that stands still sees one.
struct SequenceEvidence {
  int query_view = 0;
  int match_view = 0;
  int num_views = 0;     // of the longest sequence through the candidate, as far as it is known
  int num_inliers = 0;   // of all of this sequence together
  bool is_over = false;  // has been pending for verify.max_pending_views
};

// Everything measured about one candidate. A part that was not measured is absent.
struct Evidence {
  double similarity = 0.0;
  std::optional<GeometryEvidence> geometry;
  std::optional<OdometryEvidence> odometry;
  std::optional<DeformationEvidence> deformation;  // verify.method deformation
  std::optional<CompetingLoopEvidence> competing_loop;
  std::optional<CompetingPlaceEvidence> competing_place;
  std::optional<SequenceEvidence> sequence;
};

// The checks, in their order; the first that fails decides. kEvidence: all that is known would also
// hold of a look-alike place; kGraph: accepted by the loop verifier, but rejected by the robust
// pose graph together with odometry and the loops before; kWithdrawn: contradicted by a later loop.
enum class Refusal {
  kSimilarity,
  kPause,
  kMatches,
  kInliers,
  kSpread,
  kPose,
  kConsistency,
  kOdometry,
  kDeformation,
  kCompeting,
  kSequence,
  kEvidence,
  kGraph,
  kWithdrawn
};

inline constexpr Refusal kAllRefusals[] = {
    Refusal::kSimilarity,  Refusal::kPause,     Refusal::kMatches,     Refusal::kInliers,
    Refusal::kSpread,      Refusal::kPose,      Refusal::kConsistency, Refusal::kOdometry,
    Refusal::kDeformation, Refusal::kCompeting, Refusal::kSequence,    Refusal::kEvidence,
    Refusal::kGraph,       Refusal::kWithdrawn};

std::string_view name_of(Refusal refusal);

// The two views show the same place.
struct LoopClosure {
  CandidateId candidate;
  Evidence evidence;
  std::optional<Sim3>
      match_from_query;  // none: counted as a loop, but adds no edge (profile paper without a pose)
  bool scale_is_free = false;  // monocular: the scale of match_from_query was estimated
  Matrix6d information = Matrix6d::Identity();  // of match_from_query, order [m; rad]
  bool is_by_hand = false;  // accepted by `ledger force`, whatever the verifier decided
  // Valid: that loop and those after it contradict this one and are less likely under odometry.
  CandidateId overruled = {};
};

// A check failed.
struct Rejection {
  CandidateId candidate;
  Evidence evidence;
  Refusal stage = Refusal::kSimilarity;
  std::string reason;  // one sentence with the figure and the threshold
};

// Undecided, or pending: the views that follow decide.
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
