#pragma once

#include <algorithm>
#include <set>
#include <vector>

#include <samewhere/pipeline/view_evidence.hpp>

namespace samewhere::pipeline {

// A place of the map in one view: its evidence, and the pose that the evidence is of.
struct SeenPlace {
  const ViewEvidence& evidence;
  const RelocalizedPose& pose;
};

// What a camera sees of the objects in which two places of the map differ. In a cell of the image
// where the map shows landmarks at both places, the view finds those of both (the places look the
// same there), or of one alone (an object that the other place does not have). An object counts
// once, however many views show it: landmarks that were counted before count no more.
class PlaceDifferences {
 public:
  // The next view, with both places.
  void add(const features::View& view, const SeenPlace& here, const SeenPlace& there);

  // As seen from the other place.
  PlaceDifferences swapped() const;

  double only_here() const { return only_here_; }    // objects
  double only_there() const { return only_there_; }  // objects
  double both() const { return both_; }              // objects

  // Whether both places explain most of the view. Otherwise the pose at the other one is poor, or
  // it only shares some objects, and the differences say nothing.
  bool is_lookalike() const { return both_ >= std::max(only_here_, only_there_); }

  // Whether the views show this place and not the other, or the reverse: they find several objects
  // of it alone, and almost none of the other alone.
  bool is_here() const { return is_shown(only_here_, only_there_); }
  bool is_there() const { return is_shown(only_there_, only_here_); }

 private:
  double count(const std::vector<core::LandmarkId>& inliers);
  bool is_shown(double own, double others) const;

  double only_here_ = 0.0;
  double only_there_ = 0.0;
  double both_ = 0.0;
  std::set<core::LandmarkId> counted_;
};

// Logarithm of a likelihood ratio: of this place against a look-alike that is not in the map. A
// third place differs from both places of the map, and shows objects of either alone about as
// often, or, if it is closer to this one (kShareOfCloser), more of this one; the place itself shows
// its own.
double log_ratio_by_differences(const PlaceDifferences& differences);
// The same for so many objects of this place alone and of the other alone, none of them by chance.
double log_ratio_by_objects(double own, double others);

}  // namespace samewhere::pipeline
