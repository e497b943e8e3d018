#pragma once

#include <optional>
#include <vector>

#include <samewhere/features/match_pair.hpp>
#include <samewhere/map/config.hpp>
#include <samewhere/scene/local_map.hpp>
#include <samewhere/scene/tracked_view.hpp>

namespace samewhere::map {

// Two views without depth, their relative pose, and the points observed by both.
struct ViewPair {
  features::View first;
  features::View second;
  core::Rigid3 first_from_second;                           // camera 0 of either
  core::Matrix6d information = core::Matrix6d::Identity();  // of the second body in the first
  std::vector<features::Match> matches;          // first and second: features of either view
  std::vector<Eigen::Vector3d> points_in_first;  // one per match, in the first camera
};

// How many features of the view could become landmarks: those with depth.
int num_with_depth(const features::View& view);

// Whether the view can start a map: enough features with depth.
bool can_start(const features::View& view, const Config& config);

// Whether the view could be a keyframe of this map: enough features with depth, or any view where
// the map was started without.
bool can_keep(const scene::MapVersion& map, const features::View& view, const Config& config);

// The local map of tracking around a keyframe.
scene::LocalMap local_map(const scene::MapVersion& map, core::KeyframeId reference,
                          const Config& config);

// Median depth of the visible landmarks of the view along its optical axis, map units; 0: none.
double median_landmark_depth(const scene::MapVersion& map, const scene::TrackedView& tracked);

// Keyframe decision: whether the view moved or turned far from its reference keyframe or tracks few
// of its landmarks, and keyframes of two minutes ago do not observe most of it.
bool is_worth_keeping(const scene::MapVersion& map, const scene::TrackedView& tracked,
                      const Config& config);

// The edit that makes the view the next keyframe. Without a pose it is the first of its session and
// stands at `world_from_body`.
scene::Edit start_map(const scene::MapVersion& map, const features::View& view,
                      const core::Rigid3& world_from_body);
// The edit that inserts two views as keyframes, the first of a session at the origin of the world,
// with their relative pose and without an edge to earlier keyframes.
scene::Edit start_map(const scene::MapVersion& map, const ViewPair& pair);
// The reset: an edit that culls every landmark. The keyframes stay for place recognition.
scene::Edit give_up(const scene::MapVersion& map);
scene::Edit add_keyframe(const scene::MapVersion& map, const scene::TrackedView& tracked);

}  // namespace samewhere::map
