#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <samewhere/core/frame_pose.hpp>
#include <samewhere/features/match_pair.hpp>
#include <samewhere/features/match_projected.hpp>
#include <samewhere/optimize/motion_only.hpp>
#include <samewhere/scene/local_map.hpp>
#include <samewhere/track/config.hpp>
#include <samewhere/track/depth_alignment.hpp>

namespace samewhere::track {

// A measured pose and what supports it.
struct Track {
  core::FramePose pose;
  std::vector<features::Match>
      matches;  // inliers: first = point of the local map, second = feature
  double reprojection_rmse_px = 0.0;
};

struct TrackerSettings {
  Config track;
  features::Config features;
  optimize::Config optimize;
  std::uint64_t seed = 0;
};

// Finds the pose of one view in a local map. Stateless but for the settings: the same call gives
// the same bits.
class Tracker {
 public:
  explicit Tracker(const TrackerSettings& settings) : settings_(settings) {}

  // With a guess of where the body is, landmarks are searched near their projection, first near,
  // then far.
  std::optional<Track> track(const features::View& view, const scene::LocalMap& map,
                             const core::Rigid3& guessed_reference_from_body) const;

  // Where depth pictures put the body. The features that fit there refine the pose if they are
  // enough and lead not far away; else it is the one given, and weak.
  Track track_at(const features::View& view, const scene::LocalMap& map,
                 const core::Rigid3& reference_from_body, const Alignment& alignment) const;

  // Without a guess: every near landmark may match every feature.
  std::optional<Track> track_anywhere(const features::View& view, const scene::LocalMap& map) const;

 private:
  std::vector<features::Match> search(const features::View& view, const scene::LocalMap& map,
                                      const core::Rigid3& reference_from_body,
                                      double radius_px) const;
  std::optional<Track> solve(const features::View& view, const scene::LocalMap& map,
                             const std::vector<features::Match>& matches) const;
  optimize::MotionProblem motion_problem(const features::View& view, const scene::LocalMap& map,
                                         const std::vector<features::Match>& matches) const;
  Track make_track(const features::View& view, const scene::LocalMap& map,
                   const std::vector<features::Match>& matches,
                   const optimize::MotionResult& motion) const;

  TrackerSettings settings_;
};

}  // namespace samewhere::track
