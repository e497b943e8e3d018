#pragma once

#include <vector>

#include <Eigen/Core>

namespace samewhere::pipeline {

// What a view says about a place, after a motion.
struct PlaceView {
  double found_ratio = 0.0;  // inliers per visible landmark, over what mapping found there
  double new_ratio = 0.0;    // of the inliers: landmarks that were no inliers of an earlier view
  double moved_m = 0.0;      // since the view before, where the camera had not been yet
};

// The metres of a path where it had not been yet: a corridor walked to its end and back has the
// same length in a look-alike.
class NewGround {
 public:
  // The next position, metres; `moved_m`: since the last one. Returns it, or 0 near an earlier part
  // of the path.
  double add(const Eigen::Vector3d& position, double moved_m);

 private:
  std::vector<Eigen::Vector3d> path_;
};

// Whether views show this place of the map, or a look-alike place that is not in the map: logarithm
// of a likelihood ratio, over metres. This place shows the landmarks that mapping found, or fewer
// throughout, if it has changed since. A look-alike shows as many, or fewer throughout, until the
// camera leaves what both places have in common, once in `common_length_m`; after that the map
// explains little. Views count by their new landmarks: the same landmarks again, or turning on the
// spot, add nothing. Learned on rendered sequences, seeds below 1000 (decision 034).
class PlaceEvidence {
 public:
  explicit PlaceEvidence(double common_length_m) : common_length_m_(common_length_m) {}

  void add(const PlaceView& view);

  // Of this place against a look-alike.
  double log_likelihood_ratio() const { return log_ratio_; }
  // Mean found ratio, at most that of the place itself, by new landmarks, and the number of views
  // that count as independent.
  double found_ratio() const { return weight_ > 0.0 ? found_ / weight_ : 0.0; }
  double num_independent() const { return weight_; }

 private:
  // Probabilities, given the views: of this place and of a look-alike; each sums to 1.
  struct Here {
    double as_mapped = 0.8;
    double changed = 0.2;
  };
  struct LookAlike {
    double same = 0.5;
    double differing = 0.5;
    double left = 0.0;  // the camera has left what both have in common
  };

  double common_length_m_;
  Here here_;
  LookAlike lookalike_;
  double log_ratio_ = 0.0;
  double found_ = 0.0;
  double weight_ = 0.0;
};

// Whether another place of the map is a look-alike, or only shares some objects: by its inliers per
// inlier of this place, over so many views after steps.
bool is_lookalike(double other_ratio, int num_views);

// Of look-alikes that are not in the map: so many may differ less from a place than the one in the
// map does, as the same wing one floor up. The others differ by about as much.
inline constexpr double kShareOfCloser = 0.2;

// Evidence of a look-alike place in the map that explains the views clearly worse: one that is not
// in the map would leave the winner with fewer inliers, too, unless it is closer. `found_ratio`: of
// the winner, over what mapping found; `other_ratio`: inliers of the look-alike per inlier of the
// winner; `num_views`: independent ones.
double log_ratio_by_lookalike(double found_ratio, double other_ratio, double num_views);

}  // namespace samewhere::pipeline
