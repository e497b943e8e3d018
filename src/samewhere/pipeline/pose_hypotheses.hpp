#pragma once

#include <functional>
#include <optional>
#include <vector>

#include <samewhere/pipeline/config.hpp>
#include <samewhere/pipeline/messages.hpp>
#include <samewhere/pipeline/view_evidence.hpp>
#include <samewhere/track/tracker.hpp>

namespace samewhere::pipeline {

// Whether the camera can have reached the pose since its last one.
using IsReachable = std::function<bool(const core::FramePose& pose)>;

// What a hypothesis needs to be accepted. Weak poses are accepted only if there is no other
// hypothesis. `is_predicted`: where motion predicts the camera; set: the hypothesis, and no other,
// is there.
struct RequiredEvidence {
  int num_views = 1;
  bool may_be_weak = false;
  IsReachable is_predicted = {};
};

// The hypothesis with most evidence, and the places of the others.
struct LeadingHypotheses {
  RelocalizedPose best;
  std::vector<Place> others;
};

struct CompetingLimits {
  double max_ratio = 0.75;
  int weak_inliers = 40;  // of a view; with fewer, inliers per visible landmark are not compared
};
// Whether another hypothesis has more than a share of the inliers of this one, or of its inliers
// per visible landmark, in the views and cells in which both are comparable; also if these are too
// few.
bool is_competing(const std::vector<ViewEvidence>& other, const std::vector<ViewEvidence>& views,
                  const CompetingLimits& limits);

// Competing hypotheses for the pose of a lost camera (decision 017). Each view is tracked in the
// local map of each hypothesis; inliers and visible landmarks are summed over the last views. A
// hypothesis is accepted once it has explained enough views and no other competes: none has about
// as many inliers, or as many inliers per visible landmark
// (track.relocalization.max_competing_ratio). Two hypotheses are compared in those cells of the
// image where the map shows similar numbers of landmarks at both; if these are few, the result is
// undecided. A place that the loop verifier recognized but where tracking fails also prevents
// acceptance.
class PoseHypotheses {
 public:
  PoseHypotheses(const Config& config, const track::Tracker& tracker)
      : map_config_(config.map), track_config_(config.track), tracker_(tracker) {}

  // Adds the evidence of the next view and returns an accepted pose, if any. `candidates`: places
  // for this view; those of earlier views are kept. Poses that hardly differ at the distance of the
  // visible landmarks are one hypothesis; poses that are not reachable are none. An accepted
  // hypothesis was recognized by the loop verifier and has the required evidence.
  std::optional<RelocalizedPose> evaluate(const features::View& view, const scene::MapVersion& map,
                                          const std::vector<Place>& candidates,
                                          const RequiredEvidence& required,
                                          const IsReachable& is_reachable);

  // Ends with the hypothesis that has most inliers, if it is recognized, not weak, and was
  // evaluated on `num_views` views. Competing hypotheses do not prevent it.
  std::optional<LeadingHypotheses> take_leading(int num_views);

  // Whether a recognized hypothesis has been evaluated on fewer than `num_views` views.
  bool has_recent(int num_views) const;

  // After relocalization, or when the map is discarded.
  void reset() { hypotheses_.clear(); }

 private:
  struct Hypothesis {
    Place place;                          // of the last view that was tracked
    std::vector<ViewEvidence> evidence;   // of the last views, oldest first
    std::optional<RelocalizedPose> pose;  // of the current view

    int num_inliers() const;  // of comparable views
  };
  // The best pose near a place, and the best other one in its local map: another hypothesis.
  struct TrackedPlace {
    std::optional<RelocalizedPose> near;
    std::optional<RelocalizedPose> elsewhere;
  };
  // Of one call of evaluate().
  struct Query {
    const features::View& view;
    const scene::MapVersion& map;
    const IsReachable& is_reachable;
  };

  TrackedPlace track_at(const Place& place, const Query& query) const;
  // With the pose as a guess and without; the one with more inliers is kept. The guess is one view
  // old, and after a rotation few of its landmarks are visible.
  void track_in_local_map(core::KeyframeId keyframe, const Place& place, const Query& query,
                          TrackedPlace& tracked) const;
  void update(Hypothesis& hypothesis, const Query& query, std::vector<Place>& elsewhere) const;
  void add(const Place& place, const Query& query);
  void update_all(const Query& query, const std::vector<Place>& candidates);
  void add_evidence(const Query& query);
  void merge_equal(const scene::MapVersion& map);
  // Whether the loop verifier recognized a reachable place that is none of the hypotheses.
  bool has_untracked_recognition(const std::vector<Place>& candidates, const Query& query) const;
  bool is_accepted(const Hypothesis& hypothesis, const RequiredEvidence& required) const;
  bool is_predicted_alone(const Hypothesis& hypothesis, const IsReachable& is_predicted) const;

  map::Config map_config_;
  track::Config track_config_;
  track::Tracker tracker_;
  std::vector<Hypothesis> hypotheses_;
};

}  // namespace samewhere::pipeline
