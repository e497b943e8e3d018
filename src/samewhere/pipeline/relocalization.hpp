#pragma once

#include <optional>
#include <vector>

#include <samewhere/pipeline/config.hpp>
#include <samewhere/pipeline/messages.hpp>
#include <samewhere/pipeline/motion_prediction.hpp>
#include <samewhere/pipeline/pose_hypotheses.hpp>
#include <samewhere/pipeline/provisional.hpp>
#include <samewhere/pipeline/session.hpp>
#include <samewhere/scene/map_version.hpp>
#include <samewhere/track/tracker.hpp>

namespace samewhere::pipeline {

// How relocalizations ended. Open: begun, neither confirmed nor taken back.
struct RelocalizationCounts {
  int num_by_motion = 0;    // confirmed at once, because motion predicted the pose
  int num_provisional = 0;  // begun
  int num_confirmed = 0;
  int num_taken_back = 0;

  int num_open() const { return num_provisional - num_confirmed - num_taken_back; }
};

// Pose of a lost camera in the whole map. Candidates come from retrieval and the loop verifier
// (LoopClosing, by FindPlace); their poses are hypotheses. A relocalization is provisional until
// evidence over metres has confirmed it, unless motion predicted the pose; with `prior: unique` it
// is confirmed as soon as one hypothesis is left. With depth, hypotheses farther than
// `track.relocalization.max_speed_m_s` times the elapsed time are rejected.
class Relocalization {
 public:
  Relocalization(const Config& config, DepthFrom depth_from);

  // Of a view. No pose: LOST. Confirmed: with its local map.
  struct Result {
    std::optional<core::FramePose> provisional;
    std::optional<RelocalizedPose> confirmed;
    // See ProvisionalRelocalization.
    std::optional<core::Rigid3> new_from_old;
    core::KeyframeId reference;  // near which the earlier frames are then
    bool is_taken_back = false;
  };
  // Evaluates the next lost view. `candidates`: places of the whole map that it may show, nullptr:
  // not retrieved. `motion`: the last of the session.
  Result evaluate(const features::View& view, const scene::MapVersion& map,
                  const std::vector<Place>* candidates, const LastMotion& motion);

  // While provisional: whether the view that was evaluated last needs candidates; they are asked
  // for, and given to evaluate() with a later view.
  bool wants_places() const { return provisional_.wants_places(); }
  void note_asked() { provisional_.note_asked(); }
  bool is_provisional() const { return provisional_.is_active(); }
  const RelocalizationCounts& counts() const { return counts_; }

  // Whether a recognized hypothesis needs more views for a decision: re-initialization waits.
  bool is_undecided(double stamp_s, const core::FramePose* last_pose) const;

  // The map is discarded.
  void reset();

 private:
  Result begin(const features::View& view, const scene::MapVersion& map,
               const std::vector<Place>& candidates, const LastMotion& motion);
  Result follow(const features::View& view, const scene::MapVersion& map,
                const std::vector<Place>* candidates);

  Config config_;
  PoseHypotheses hypotheses_;
  ProvisionalRelocalization provisional_;
  RelocalizationCounts counts_;
};

}  // namespace samewhere::pipeline
