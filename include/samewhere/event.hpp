#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <samewhere/types.hpp>

namespace samewhere {

// A frame: its 0-based position in its session. Sessions count from 0; each use of a saved map is a
// further one.
struct FrameKey {
  std::uint64_t index = 0;
  std::uint16_t session = 0;

  friend bool operator==(const FrameKey&, const FrameKey&) = default;
};

// What the verification of a loop candidate measured; what was not measured is empty.
struct LoopScores {
  double similarity = 0.0;              // of the global descriptors, in [-1, 1]
  std::optional<int> num_matches;       // feature matches
  std::optional<int> num_inliers;       // of one relative pose
  std::optional<double> inlier_ratio;   // inliers / matches
  std::optional<double> overlap_ratio;  // share of each image that the other one shows
  std::optional<double> reprojection_rmse_px;
  std::optional<double> correction_m;    // of the query's position, by the candidate
  std::optional<double> correction_rad;  // of its rotation
  std::optional<double>
      odometry_chi_square;        // of the correction under odometry; 6 degrees of freedom
  std::optional<double> sigma_m;  // of the odometry between match and query
};

// kWithdrawn: accepted before, contradicted by a later loop.
enum class LoopDecision { kAccepted, kRejected, kAmbiguous, kWithdrawn };

// A verdict on a loop candidate. A later verdict on the same candidate replaces it.
struct LoopVerdict {
  std::uint64_t candidate = 0;
  FrameKey query;
  FrameKey match;  // older
  LoopDecision decision = LoopDecision::kRejected;
  bool is_relocalization = false;  // a place for a lost camera, not a loop
  std::string check;               // that decided: "inliers", "odometry", ... as in loops.json
  std::string reason;              // one sentence with the score and the threshold
  LoopScores scores;
  std::optional<Pose> match_from_query;  // of the body; empty: not measured
  double scale = 1.0;                    // what is 1 long at the query is so long at the match
  std::optional<Covariance> covariance;  // of match_from_query; accepted ones alone
};

// The keyframe is part of the map that frames are tracked in.
struct KeyframeInserted {
  std::uint64_t keyframe = 0;
  FrameKey frame;
  double stamp_s = 0.0;
  Pose map_from_camera = Pose::Identity();
};

struct TrackingLost {
  double last_pose_stamp_s = 0.0;
};

// kProvisional: found, not confirmed. kConfirmed: the pose is used from here on. kTakenBack: the
// provisional one was wrong; the camera is lost again.
enum class RelocalizationStep { kProvisional, kConfirmed, kTakenBack };

struct Relocalized {
  RelocalizationStep step = RelocalizationStep::kProvisional;
};

// Loop closures or a full bundle adjustment moved keyframes. Local bundle adjustment, which moves
// the newest ones with each keyframe, is not told.
struct MapCorrected {
  struct Move {
    std::uint64_t keyframe = 0;
    Pose old_map_from_camera = Pose::Identity();
    Pose new_map_from_camera = Pose::Identity();
  };
  std::uint64_t map_version = 0;
  std::vector<Move> moves;  // ascending by keyframe
};

// Re-initialization: the map so far, with all its poses, is replaced by a new one.
struct MapDiscarded {};

// Told with the frame at which it takes effect.
struct Event {
  std::uint64_t frame = 0;  // index
  double stamp_s = 0.0;
  std::variant<KeyframeInserted, LoopVerdict, TrackingLost, Relocalized, MapCorrected, MapDiscarded>
      what;
};

}  // namespace samewhere
