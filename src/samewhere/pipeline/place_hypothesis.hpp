#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include <samewhere/map/config.hpp>
#include <samewhere/pipeline/place_differences.hpp>
#include <samewhere/pipeline/place_evidence.hpp>
#include <samewhere/pipeline/view_evidence.hpp>

namespace samewhere::pipeline {

// What mapping itself found at the keyframes of a map version: found_ratio_of_mapping().
class FoundRatios {
 public:
  // At the reference of a local map; 0.5 where mapping has too few landmarks.
  double at(const scene::LocalMap& local_map, const scene::MapVersion& map);

 private:
  std::map<core::KeyframeId, double> known_;
  std::uint64_t map_number_ = 0;
};

// A place of the map where the camera may be since it was relocalized, and what the views say of it
// (decision 034).
struct PlaceHypothesis {
  explicit PlaceHypothesis(double common_length_m) : evidence(common_length_m) {}

  Place place;                          // of the newest view
  std::optional<RelocalizedPose> pose;  // of the view that was evaluated last
  std::vector<ViewEvidence> views;      // the last ones after steps, oldest first
  core::Rigid3 since_step;
  double since_step_m = 0.0;
  PlaceEvidence evidence;
  NewGround new_ground;
  double log_ratio_by_motion = 0.0;
  PlaceDifferences differences;  // of the best hypothesis, from this one
  std::set<core::LandmarkId> seen;
  int num_failures = 0;  // evaluations without a pose, in a row

  // Whether its last view shows the place, not the end of the map.
  bool is_in_map() const;

  // The view at this place. One that was added before is not added again.
  void add_view(const features::View& view, const scene::MapVersion& map,
                const map::Config& config);
  // The same after a step, which counts as evidence.
  void add_step(const features::View& view, const scene::MapVersion& map, const map::Config& config,
                FoundRatios& of_mapping);
};

// Whether the camera is at this place, or at a look-alike that is not in the map: logarithm of a
// likelihood ratio, from the views of all hypotheses. `weak_inliers`: of a view; a place with fewer
// is not compared.
double log_ratio(const PlaceHypothesis& hypothesis, const std::vector<PlaceHypothesis>& all,
                 int weak_inliers);

// Whether no other hypothesis may be the place as well.
bool is_alone(const PlaceHypothesis& hypothesis, const std::vector<PlaceHypothesis>& all,
              int weak_inliers);

}  // namespace samewhere::pipeline
