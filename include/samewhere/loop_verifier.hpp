#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <samewhere/errors.hpp>
#include <samewhere/event.hpp>
#include <samewhere/types.hpp>

namespace samewhere {

/// What odometry knows of two keyframes.
struct OdometryBetween {
  Pose match_from_query = Pose::Identity();        ///< of the bodies, metres
  Covariance covariance = Covariance::Identity();  ///< of match_from_query, [m; rad]
};

/// Verification of one loop candidate, for a pose graph kept elsewhere (GTSAM, g2o). Geometry,
/// odometry gate and look-alike places as in SLAM; without a map there are no competing hypotheses
/// of earlier loops. Holds no state between calls. One thread at a time calls it.
class LoopVerifier {
 public:
  /// `settings`: "section.key=value", over profile `default`. `prior`: verify.prior. Throws
  /// InputError on a calibration or setting that cannot be used.
  explicit LoopVerifier(const Calibration& calibration,
                        const std::vector<std::string>& settings = {},
                        std::optional<Prior> prior = std::nullopt);
  ~LoopVerifier();
  LoopVerifier(const LoopVerifier&) = delete;
  LoopVerifier& operator=(const LoopVerifier&) = delete;

  /// Whether both frames show the same place. Without depth or a second camera there is no relative
  /// pose, so that nothing is accepted. Without odometry the prior kRepetitive accepts nothing.
  /// Throws InputError as Slam::track(), and for odometry that is no rigid pose or whose covariance
  /// is not positive definite; stamps are not compared.
  LoopVerdict verify(const Frame& match, const Frame& query,
                     const std::optional<OdometryBetween>& odometry = std::nullopt) const;

 private:
  struct Parts;
  std::unique_ptr<const Parts> parts_;
};

}  // namespace samewhere
