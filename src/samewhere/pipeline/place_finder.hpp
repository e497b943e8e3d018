#pragma once

#include <functional>
#include <optional>
#include <vector>

#include <samewhere/pipeline/config.hpp>
#include <samewhere/pipeline/messages.hpp>
#include <samewhere/scene/local_map.hpp>
#include <samewhere/track/tracker.hpp>

namespace samewhere::pipeline {

// Where a lost view was taken.
struct FoundPlace {
  scene::LocalMap around;
  track::Track track;  // relative to around.reference
};

// Whether one can have got there since the last pose.
using IsWithinReach = std::function<bool(const core::FramePose& pose)>;

// Where is somebody who is lost? Every place of the map where the views since then may have been
// taken is held against every other: each view is tracked among the landmarks of each, and what
// they explain is added up. One place is found once it has explained enough views, and no other
// about as much of the same views, or as much of what it has to show for itself where the map knows
// little (track.max_lost_rival_ratio). Until then nobody can tell; the places are kept, for whoever
// walks on learns in the end which of them goes on as the views do.
class PlaceFinder {
 public:
  // Both outlive it.
  PlaceFinder(const Config& config, const track::Tracker& tracker)
      : config_(config), tracker_(tracker) {}

  // The next view. `places`: where it may have been taken, those of earlier views need not be told
  // again. Two poses that hardly differ for what is in sight are one place; what is beyond reach is
  // no place. Found are `num_views` at least.
  std::optional<FoundPlace> look(const features::View& view, const scene::MapVersion& map,
                                 const std::vector<Place>& places, int num_views,
                                 const IsWithinReach& is_within_reach);

  // Whether some place was thought of too late to have explained `num_views` views yet.
  bool has_fresh_place(int num_views) const;

  // Nobody is lost any more.
  void forget() { hypotheses_.clear(); }

 private:
  // What a place makes of a view.
  struct Explained {
    int num_inliers = 0;
    int num_expected = 0;  // landmarks that should be in sight there
  };
  struct Hypothesis {
    Place place;                       // as it explained a view last
    std::vector<Explained> explained;  // of the last few views that could speak about it
    std::optional<FoundPlace> found;   // of this view

    Explained sum_of_last(std::size_t num_views) const;
  };

  // With or without a guess, whichever explains more: the guess is a view old, and who turns sees
  // little of what is near it.
  std::optional<FoundPlace> track_around(
      core::KeyframeId keyframe, const features::View& view, const scene::MapVersion& map,
      const std::optional<core::Rigid3>& keyframe_from_body) const;
  void look_at(const Place& place, const features::View& view, const scene::MapVersion& map,
               const IsWithinReach& is_within_reach, Hypothesis& hypothesis) const;
  void think_of(const Place& place, const features::View& view, const scene::MapVersion& map,
                const IsWithinReach& is_within_reach);
  void merge(const scene::MapVersion& map);
  Explained explained(const Hypothesis& hypothesis, const features::View& view,
                      const scene::MapVersion& map) const;
  void record(const features::View& view, const scene::MapVersion& map);
  bool is_rival(const Hypothesis& other, const Hypothesis& hypothesis) const;

  const Config& config_;
  const track::Tracker& tracker_;
  std::vector<Hypothesis> hypotheses_;
};

}  // namespace samewhere::pipeline
