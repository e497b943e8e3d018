#pragma once

#include <compare>
#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include <samewhere/core/rigid3.hpp>

namespace samewhere::core {

// Pose of camera 0 at one moment.
struct StampedPose {
  double stamp_s = 0.0;
  Rigid3 world_from_camera;
};

using Trajectory = std::vector<StampedPose>;  // stamps ascend strictly

// Velocity of the body and biases of its inertial unit at one moment.
struct InertialTruth {
  double stamp_s = 0.0;
  Eigen::Vector3d velocity_m_s = Eigen::Vector3d::Zero();             // of the body, in the world
  Eigen::Vector3d gyroscope_bias_rad_s = Eigen::Vector3d::Zero();     // in body axes
  Eigen::Vector3d accelerometer_bias_m_s2 = Eigen::Vector3d::Zero();  // in body axes
};

// Whether two frames show the same place (docs/evaluation.md, protocol pr-v2).
enum class PlaceTruth : std::uint8_t { kDifferent = 0, kSame = 1, kNear = 2 };

// Square matrix over the frames of a source: row = query, column = match.
struct PlaceTruthMatrix {
  int num_frames = 0;
  std::vector<PlaceTruth> values;  // row-major, num_frames * num_frames

  PlaceTruth at(int query, int match) const {
    return values[static_cast<std::size_t>(query) * static_cast<std::size_t>(num_frames) +
                  static_cast<std::size_t>(match)];
  }
};

// Two frames of a source, by their 0-based positions; query > match.
struct FramePair {
  int query = 0;
  int match = 0;

  friend auto operator<=>(const FramePair&, const FramePair&) = default;
};

// Frames one after another, by their 0-based positions; the last one included.
struct FrameSpan {
  int first = 0;
  int last = 0;

  friend bool operator==(const FrameSpan&, const FrameSpan&) = default;
};

// Ground truth of a source; each part may be missing.
struct Truth {
  Trajectory trajectory;                // empty: not known
  std::vector<InertialTruth> inertial;  // at the stamps of the trajectory; empty: not known
  std::optional<PlaceTruthMatrix> places;
  // Aliased pairs: frames of different places with similar appearance, known by construction of a
  // rendered building; ascending, no pair twice. Empty: none, or not known.
  std::vector<FramePair> aliased_pairs;
  // Revisits of an earlier place, each with at least one frame that shows it unambiguously, known
  // by construction of a rendered building; ascending. Nothing: not known.
  std::optional<std::vector<FrameSpan>> revisits;
};

}  // namespace samewhere::core
