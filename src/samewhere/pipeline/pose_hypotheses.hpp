#pragma once

#include <array>
#include <functional>
#include <optional>
#include <vector>

#include <samewhere/pipeline/config.hpp>
#include <samewhere/pipeline/messages.hpp>
#include <samewhere/scene/local_map.hpp>
#include <samewhere/track/tracker.hpp>

namespace samewhere::pipeline {

// Pose of a lost view in the map.
struct RelocalizedPose {
  scene::LocalMap local_map;
  track::Track track;  // relative to local_map.reference
};

// Whether the camera can have reached the pose since its last one.
using IsReachable = std::function<bool(const core::FramePose& pose)>;

// What a hypothesis needs to be accepted. Weak poses are accepted only if there is no other
// hypothesis.
struct RequiredEvidence {
  int num_views = 1;
  bool may_be_weak = false;
};

// Competing hypotheses for the pose of a lost camera (decision 017). Each view is tracked in the
// local map of each hypothesis; inliers and visible landmarks are summed over the last views. A
// hypothesis is accepted once it has explained enough views and no other competes: none has about
// as many inliers, or as many inliers per visible landmark (track.relocalization.max_competing_ratio). Two
// hypotheses are compared in those cells of the image where the map shows similar numbers of
// landmarks at both; if these are few, the result is undecided. A place that the loop verifier
// recognized but where tracking fails also prevents acceptance.
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

  // Whether a recognized hypothesis has been evaluated on fewer than `num_views` views.
  bool has_recent(int num_views) const;

  // After relocalization, or when the map is discarded.
  void reset() { hypotheses_.clear(); }

 private:
  // In a view, or in a cell of it.
  struct Counts {
    int num_inliers = 0;
    int num_visible = 0;  // landmarks that project into it

    Counts& operator+=(const Counts& more) {
      num_inliers += more.num_inliers;
      num_visible += more.num_visible;
      return *this;
    }
  };
  static constexpr int kColumns = 8;
  static constexpr int kRows = 6;
  // Evidence of one view for a hypothesis.
  struct ViewEvidence {
    Counts total;
    std::array<Counts, std::size_t{kColumns} * kRows> cells;  // row by row
    bool is_comparable = false;  // false: the map ends in the viewing direction
  };
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
  ViewEvidence measure(const Hypothesis& hypothesis, const Query& query) const;
  void add_evidence(const Query& query);
  void merge_equal(const scene::MapVersion& map);
  // Whether the loop verifier recognized a reachable place that is none of the hypotheses.
  bool has_untracked_recognition(const std::vector<Place>& candidates, const Query& query) const;
  // Whether the map shows similar numbers of landmarks at both.
  static bool are_comparable(const Counts& a, const Counts& b);
  bool is_competing(const Hypothesis& other, const Hypothesis& hypothesis) const;
  bool is_accepted(const Hypothesis& hypothesis, const RequiredEvidence& required) const;

  map::Config map_config_;
  track::Config track_config_;
  track::Tracker tracker_;
  std::vector<Hypothesis> hypotheses_;
};

}  // namespace samewhere::pipeline
