#pragma once

#include <optional>
#include <vector>

#include <samewhere/features/match_pair.hpp>
#include <samewhere/map/config.hpp>
#include <samewhere/scene/local_map.hpp>
#include <samewhere/scene/tracked_view.hpp>

namespace samewhere::map {

// Two views without depth, how they stand to each other, and the points that both see.
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

// What tracking looks for around a keyframe.
scene::LocalMap local_map(const scene::MapVersion& map, core::KeyframeId reference,
                          const Config& config);

// Median depth of the landmarks that the view shows, along its optical axis, map units; 0: it shows
// none.
double median_landmark_depth(const scene::MapVersion& map, const scene::TrackedView& tracked);

// Whether the view shows enough new to be kept: moved or turned far from its reference keyframe, or
// lost sight of it; and keyframes of two minutes ago do not see most of what it shows.
bool is_worth_keeping(const scene::MapVersion& map, const scene::TrackedView& tracked,
                      const Config& config);

// The edit that makes the view the next keyframe. Without a pose it is the first of its session and
// stands at `world_from_body`.
scene::Edit start_map(const scene::MapVersion& map, const features::View& view,
                      const core::Rigid3& world_from_body);
// The edit that makes two views the next keyframes, the first of a session at the world's origin:
// they stand to each other, and to none that was there before.
scene::Edit start_map(const scene::MapVersion& map, const ViewPair& pair);
// The edit after which the map shows nothing: every landmark is culled. The keyframes stay, as
// pictures of the past.
scene::Edit give_up(const scene::MapVersion& map);
scene::Edit add_keyframe(const scene::MapVersion& map, const scene::TrackedView& tracked);

}  // namespace samewhere::map
