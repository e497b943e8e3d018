#pragma once

#include <optional>
#include <vector>

#include <samewhere/pipeline/config.hpp>
#include <samewhere/pipeline/place_hypothesis.hpp>
#include <samewhere/pipeline/pose_hypotheses.hpp>

namespace samewhere::pipeline {

// A relocalization that is not confirmed (decision 034). The camera is tracked in the local map of
// the best hypothesis; the others move with it and are evaluated on the same views, one a frame.
// "A place that is not in the map" is always one of the hypotheses. Evidence is counted by motion:
// a view counts after a step, and by the landmarks that it adds.
class ProvisionalRelocalization {
 public:
  ProvisionalRelocalization(const Config& config, const track::Tracker& tracker);

  // `log_ratio_by_motion`: of the leading hypothesis, see MotionPrediction.
  void begin(LeadingHypotheses leading, double log_ratio_by_motion, const features::View& view);
  bool is_active() const { return !hypotheses_.empty(); }
  void reset() { hypotheses_.clear(); }

  // Whether places of the whole map are to be retrieved for the view that was evaluated last, and
  // that they are: evaluate() gets them with a later view.
  bool wants_places() const;
  void note_asked();

  enum class Decision { kOpen, kConfirmed, kTakenBack };
  struct Result {
    Decision decision = Decision::kOpen;
    std::optional<RelocalizedPose> confirmed;
    core::FramePose pose;  // unless taken back; where tracking fails, by visual odometry
    // Set: another hypothesis is the best one now. Earlier poses in the world change by it.
    std::optional<core::Rigid3> new_from_old;
  };
  // The next view. `places`: of the view that they were asked for, nullptr: none were.
  Result evaluate(const features::View& view, const scene::MapVersion& map,
                  const std::vector<Place>* places);

 private:
  // Of one call of evaluate().
  struct Query {
    const features::View& view;
    const scene::MapVersion& map;
  };

  PlaceHypothesis& best() { return hypotheses_.front(); }
  void track(PlaceHypothesis& hypothesis, const Query& query) const;
  core::Rigid3 estimate_motion(const Place& before, const Query& query);
  void advance(const core::Rigid3& last_from_this, const Query& query);
  void evaluate_one_other(const Query& query);
  void merge_equal(const scene::MapVersion& map);
  void add_places(const std::vector<Place>& places, const Query& query);
  std::optional<core::Rigid3> switch_best(const scene::MapVersion& map);
  bool has_untracked_recognition(const std::vector<Place>& places,
                                 const scene::MapVersion& map) const;
  static core::FramePose pose_of(const PlaceHypothesis& hypothesis, const Query& query);
  Decision decide(const std::vector<Place>* places, const Query& query) const;

  Config config_;
  track::Tracker tracker_;
  std::vector<PlaceHypothesis> hypotheses_;  // the best first
  features::View last_view_;
  core::Rigid3 last_motion_;  // constant velocity
  core::Rigid3 since_asked_;
  double since_asked_m_ = 0.0;
  FoundRatios found_ratios_;
  int num_unmeasured_ = 0;  // views in a row that the best hypothesis did not explain
};

}  // namespace samewhere::pipeline
