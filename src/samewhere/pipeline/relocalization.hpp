#pragma once

#include <optional>
#include <vector>

#include <samewhere/pipeline/config.hpp>
#include <samewhere/pipeline/messages.hpp>
#include <samewhere/pipeline/pose_hypotheses.hpp>
#include <samewhere/pipeline/session.hpp>
#include <samewhere/scene/map_version.hpp>
#include <samewhere/track/tracker.hpp>

namespace samewhere::pipeline {

// Pose of a lost camera in the whole map. Candidates come from retrieval and the loop verifier
// (LoopClosing, by FindPlace); their poses are hypotheses until one is left. Shortly after the loss
// the camera is near its last pose, and less evidence is required. With depth, hypotheses farther
// than `track.relocalization.max_speed_m_s` times the elapsed time are rejected.
class Relocalization {
 public:
  Relocalization(const Config& config, DepthFrom depth_from);

  // Evaluates the next lost view. `candidates`: places of the whole map that it may show.
  // `last_pose`: the last measured pose of the session, nullptr if there is none.
  std::optional<RelocalizedPose> evaluate(const features::View& view, const scene::MapVersion& map,
                                          const std::vector<Place>& candidates,
                                          const core::FramePose* last_pose);

  // Whether a recognized hypothesis needs more views for a decision: re-initialization waits.
  bool is_undecided(double stamp_s, const core::FramePose* last_pose) const;

  // The map is discarded.
  void reset() { hypotheses_.reset(); }

 private:
  Config config_;
  PoseHypotheses hypotheses_;
};

}  // namespace samewhere::pipeline
