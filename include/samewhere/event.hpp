#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <samewhere/types.hpp>

namespace samewhere {

/// A frame: its 0-based position in its session. Sessions count from 0; each use of a saved map is
/// a further one.
struct FrameKey {
  std::uint64_t index = 0;    ///< position in its session, from 0
  std::uint16_t session = 0;  ///< of the map, from 0

  /// The same frame.
  friend bool operator==(const FrameKey&, const FrameKey&) = default;
};

/// What the verification of a loop candidate measured; what was not measured is empty.
struct LoopScores {
  double similarity = 0.0;              ///< of the global descriptors, in [-1, 1]
  std::optional<int> num_matches;       ///< feature matches
  std::optional<int> num_inliers;       ///< matches that agree with one relative pose
  std::optional<double> inlier_ratio;   ///< num_inliers / num_matches, in [0, 1]
  std::optional<double> overlap_ratio;  ///< share of each image that the other one shows, in [0, 1]
  std::optional<double> reprojection_rmse_px;  ///< of the inliers, pixels
  std::optional<double> correction_m;          ///< of the query's position by the candidate, metres
  std::optional<double> correction_rad;  ///< of the query's rotation by the candidate, radians
  /// Of the correction under the accumulated drift: squared Mahalanobis distance, 6 degrees of
  /// freedom.
  std::optional<double> odometry_chi_square;
  std::optional<double>
      sigma_m;  ///< standard deviation of the odometry between match and query, metres
};

/// What was decided on a loop candidate.
enum class LoopDecision {
  kAccepted,   ///< a loop closure
  kRejected,   ///< a check failed
  kAmbiguous,  ///< it cannot be told from a look-alike place
  kWithdrawn   ///< accepted before, contradicted by a later loop
};

/// A verdict on a loop candidate. A later verdict on the same candidate replaces it.
struct LoopVerdict {
  std::uint64_t candidate = 0;                      ///< id, unique in its session
  FrameKey query;                                   ///< the newer frame
  FrameKey match;                                   ///< the older frame
  LoopDecision decision = LoopDecision::kRejected;  ///< accepted, rejected, ambiguous or withdrawn
  bool is_relocalization = false;                   ///< a place for a lost camera, not a loop
  std::string check;   ///< the check that decided, as in loops.json: "inliers", "odometry", ...
  std::string reason;  ///< one sentence with the score and the threshold
  LoopScores scores;   ///< what was measured
  std::optional<Pose> match_from_query;  ///< of the bodies, metres; empty: not measured
  double scale = 1.0;  ///< length at the match / length at the query (scale drift)
  std::optional<Covariance> covariance;  ///< of match_from_query, [m; rad]; accepted ones alone
};

/// The keyframe is part of the map that frames are tracked in.
struct KeyframeInserted {
  std::uint64_t keyframe = 0;               ///< id, as in Map::Keyframe
  FrameKey frame;                           ///< the frame that became a keyframe
  double stamp_s = 0.0;                     ///< of that frame, seconds
  Pose map_from_camera = Pose::Identity();  ///< camera 0 when it was inserted
};

/// The first frame without a pose after frames with one.
struct TrackingLost {
  double last_pose_stamp_s = 0.0;  ///< stamp of the last frame with a pose, seconds
};

/// How far relocalization is.
enum class RelocalizationStep {
  kProvisional,  ///< a pose was found and is not confirmed
  kConfirmed,    ///< the pose is used from here on
  kTakenBack     ///< the provisional pose was wrong; the camera is lost again
};

/// A step of relocalization.
struct Relocalized {
  RelocalizationStep step = RelocalizationStep::kProvisional;  ///< what happened
};

/// Loop closures or a full bundle adjustment moved keyframes. Local bundle adjustment, which moves
/// the newest ones with each keyframe, is not told.
struct MapCorrected {
  /// A keyframe with its pose before and after.
  struct Move {
    std::uint64_t keyframe = 0;                   ///< id, as in Map::Keyframe
    Pose old_map_from_camera = Pose::Identity();  ///< camera 0 before
    Pose new_map_from_camera = Pose::Identity();  ///< camera 0 after
  };
  std::uint64_t map_version = 0;  ///< Map::version() of the corrected map
  std::vector<Move> moves;        ///< ascending by keyframe
};

/// Re-initialization: the map so far, with all its poses, is replaced by a new one.
struct MapDiscarded {};

/// Something that happened in a session, told with the frame at which it takes effect.
struct Event {
  std::uint64_t frame = 0;  ///< index of that frame in its session
  double stamp_s = 0.0;     ///< of that frame, seconds
  /// What happened.
  std::variant<KeyframeInserted, LoopVerdict, TrackingLost, Relocalized, MapCorrected, MapDiscarded>
      what;
};

}  // namespace samewhere
