#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include <samewhere/core/ids.hpp>
#include <samewhere/map/config.hpp>
#include <samewhere/pipeline/messages.hpp>
#include <samewhere/scene/local_map.hpp>
#include <samewhere/scene/map_version.hpp>
#include <samewhere/track/tracker.hpp>

// What one view says about one place of the map.

namespace samewhere::pipeline {

// Pose of a view in the map.
struct RelocalizedPose {
  scene::LocalMap local_map;
  track::Track track;  // relative to local_map.reference
};

Place place_of(const RelocalizedPose& pose);
core::Rigid3 world_from_body(const scene::MapVersion& map, const Place& place);
// Of the inlier landmarks, from the camera, map units; 0: none.
double median_distance(const RelocalizedPose& pose);
// The keyframe that shows most of the inlier landmarks.
core::KeyframeId nearest_keyframe(const scene::MapVersion& map, const RelocalizedPose& pose);
// Whether two poses hardly differ at this distance of the visible landmarks.
bool are_one_place(const scene::MapVersion& map, const Place& a, const Place& b, double distance);

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

// Evidence of one view for a place.
struct ViewEvidence {
  static constexpr int kColumns = 8;
  static constexpr int kRows = 6;

  core::FrameId frame;
  Counts total;
  std::array<Counts, std::size_t{kColumns} * kRows> cells;  // row by row
  bool is_comparable = false;  // false: the map ends in the viewing direction
};

// At the pose, or without one at the place: there landmarks are visible and none is an inlier.
ViewEvidence measure_view(const features::View& view, const scene::MapVersion& map,
                          const Place& place, const RelocalizedPose* pose,
                          const map::Config& config);

// The inlier landmarks of a pose, by the cell of the view that shows them.
using InliersByCell = std::array<std::vector<core::LandmarkId>,
                                 std::size_t{ViewEvidence::kColumns} * ViewEvidence::kRows>;
InliersByCell inliers_by_cell(const features::View& view, const RelocalizedPose& pose);

// Whether the map shows similar numbers of landmarks at both.
bool are_comparable(const Counts& a, const Counts& b);

// Sums over the views of both, by frame, in which both are comparable.
struct ComparedCounts {
  Counts a;  // in comparable cells
  Counts b;
  Counts a_in_all;
  Counts b_in_all;
  int num_views = 0;
};
ComparedCounts compare(const std::vector<ViewEvidence>& a, const std::vector<ViewEvidence>& b);

// Share of the visible landmarks that mapping itself found at the reference of a local map: of the
// landmarks that project into it, those that it observes. Landmarks that it introduced are left
// out. Nothing where there are too few.
std::optional<double> found_ratio_of_mapping(const scene::MapVersion& map,
                                             const scene::LocalMap& local_map);

}  // namespace samewhere::pipeline
