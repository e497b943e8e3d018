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

// Where a lost view was taken.
struct FoundPlace {
  scene::LocalMap around;
  track::Track track;  // relative to around.reference
};

// Whether one can have got there since the last pose.
using IsWithinReach = std::function<bool(const core::FramePose& pose)>;

// What must speak for a place. Who looked away for a moment is near where he was: one view is
// enough, and if reach bounds where he can be, a weak pose will do where no other place was thought
// of.
struct Proof {
  int num_views = 1;
  bool may_be_weak = false;
};

// Where is somebody who is lost? Every place of the map where the views since then may have been
// taken is held against every other: each view is tracked among the landmarks of each, and what
// they explain of the same views is added up. One place is found once it has explained enough
// views, and no other about as many inliers, or as many of the landmarks that should be in sight
// there (track.lost.max_rival_ratio). Two places are held against each other in those cells of a
// view in which the map shows about as much at both; with hardly any, nobody can tell. Until then
// nobody can tell, either; the places are kept, for whoever walks on learns in the end which of
// them goes on as the views do. A place that the judge recognised in the view, though nothing can
// be tracked there or its map shows too little, is another place all the same: while there is one,
// nobody can tell.
class PlaceFinder {
 public:
  // Both outlive it.
  PlaceFinder(const Config& config, const track::Tracker& tracker)
      : config_(config), tracker_(tracker) {}

  // The next view. `places`: where it may have been taken, those of earlier views need not be told
  // again. Two poses that hardly differ for what is in sight are one place; what is beyond reach is
  // no place. What is found was recognised and has this proof.
  std::optional<FoundPlace> look(const features::View& view, const scene::MapVersion& map,
                                 const std::vector<Place>& places, const Proof& proof,
                                 const IsWithinReach& is_within_reach);

  // Whether some place was thought of too late to have explained `num_views` views yet.
  bool has_fresh_place(int num_views) const;

  // Nobody is lost any more, or the map is given up.
  void forget() { hypotheses_.clear(); }

 private:
  // What a place makes of a view, or of a cell of it.
  struct Evidence {
    int num_inliers = 0;
    int num_expected = 0;  // landmarks that should be in sight there

    Evidence& operator+=(const Evidence& more) {
      num_inliers += more.num_inliers;
      num_expected += more.num_expected;
      return *this;
    }
  };
  static constexpr int kColumns = 8;
  static constexpr int kRows = 6;
  struct Explained {
    Evidence all;
    std::array<Evidence, std::size_t{kColumns} * kRows> cells;  // row by row
    bool is_testable = false;  // else the map ends where the view looks
  };
  struct Hypothesis {
    Place place;                       // as it explained a view last
    std::vector<Explained> explained;  // of each view since it was thought of, of the last few
    std::optional<FoundPlace> found;   // of this view

    int num_inliers() const;  // of the views that may speak
  };
  // Near a place, and the best explanation elsewhere in its local map: another place.
  struct Sight {
    std::optional<FoundPlace> found;
    std::optional<FoundPlace> elsewhere;
  };

  struct Question {
    const features::View& view;
    const scene::MapVersion& map;
    const IsWithinReach& is_within_reach;
  };

  Sight look_at(const Place& place, const Question& question) const;
  // Near the guess and anywhere, whichever explains more: the guess is a view old, and who turns
  // sees little of what is near it.
  void track_around(core::KeyframeId keyframe, const Place& place, const Question& question,
                    Sight& sight) const;
  void think_of(const Place& place, const Question& question);
  Explained explained(const Hypothesis& hypothesis, const features::View& view,
                      const scene::MapVersion& map) const;
  void record(const features::View& view, const scene::MapVersion& map);
  void merge(const scene::MapVersion& map);
  // Whether the judge recognised one of them where no hypothesis is.
  bool has_unheard(const std::vector<Place>& places, const Question& question) const;
  // Whether the map shows about as much there at the one as at the other.
  static bool are_comparable(const Evidence& a, const Evidence& b);
  bool is_rival(const Hypothesis& other, const Hypothesis& hypothesis) const;
  bool is_proven(const Hypothesis& hypothesis, const Proof& proof) const;

  const Config& config_;
  const track::Tracker& tracker_;
  std::vector<Hypothesis> hypotheses_;
};

}  // namespace samewhere::pipeline
