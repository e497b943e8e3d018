#include <algorithm>
#include <cstring>
#include <set>

#include <samewhere/map/fuse.hpp>
#include <samewhere/map/seen.hpp>

namespace samewhere::map {
namespace {

using scene::Landmark;
using scene::MapVersion;

std::vector<core::LandmarkId> landmarks_of(const MapVersion& map,
                                           const std::vector<core::KeyframeId>& keyframes) {
  std::set<core::LandmarkId> ids;
  for (const auto& keyframe : keyframes) {
    for (const auto& id : map.at(keyframe).slots) {
      if (id.is_valid()) ids.insert(id);
    }
  }
  return {ids.begin(), ids.end()};
}

bool are_seen_together(const Landmark& a, const Landmark& b) {
  return std::any_of(a.observations.begin(), a.observations.end(),
                     [&](const scene::Observation& o) { return is_seen_by(b, o.keyframe); });
}

// The younger goes into the older if both were seen as often.
scene::Merge merge_of(const Landmark& a, const Landmark& b) {
  const auto rank = [](const Landmark& landmark) {
    return std::pair(landmark.observations.size(), ~landmark.id.value());
  };
  return rank(a) > rank(b) ? scene::Merge{b.id, a.id, {}} : scene::Merge{a.id, b.id, {}};
}

// Those that share enough landmarks with the keyframe, most first.
std::vector<core::KeyframeId> neighbours_of(const MapVersion& map, core::KeyframeId keyframe,
                                            const Config& config) {
  std::vector<core::KeyframeId> neighbours;
  for (const auto& covisible : covisible_keyframes(map, keyframe)) {
    if (covisible.num_shared < config.min_shared ||
        static_cast<int>(neighbours.size()) == config.search_keyframes) {
      break;
    }
    neighbours.push_back(covisible.keyframe);
  }
  return neighbours;
}

}  // namespace

scene::Edit fuse_into(const MapVersion& map, core::KeyframeId keyframe_id,
                      const std::vector<core::LandmarkId>& landmarks, const Config& config,
                      const features::Config& features) {
  const scene::Keyframe& keyframe = map.at(keyframe_id);
  std::vector<features::ProjectedPoint> points;
  cv::Mat descriptors(static_cast<int>(landmarks.size()), 32, CV_8U);
  for (std::size_t i = 0; i < landmarks.size(); ++i) {
    const Landmark& landmark = map.at(landmarks[i]);
    if (!is_live(landmark) || is_seen_by(landmark, keyframe_id)) continue;
    auto point = expected_at(map, keyframe, landmark, features);
    if (!point) continue;
    point->row = static_cast<int>(i);
    std::memcpy(descriptors.ptr(point->row), landmark.descriptor.data(),
                landmark.descriptor.size());
    points.push_back(*point);
  }

  scene::Edit edit;
  const core::Rigid3 from_world = camera_from_world(map, keyframe);
  for (const auto& match :
       match_projected(points, descriptors, keyframe.view, config.fuse_radius_px, features)) {
    const Landmark& landmark = map.at(landmarks[static_cast<std::size_t>(match.first)]);
    const Eigen::Vector3d in_camera = from_world * position_in_world(map, landmark);
    if (!is_inlier(reproject(keyframe.view, match.second, in_camera, features))) continue;
    const core::LandmarkId shown = keyframe.slots[static_cast<std::size_t>(match.second)];
    if (!shown.is_valid()) {
      edit.sightings.push_back({landmark.id, {keyframe_id, match.second}});
    } else if (!are_seen_together(landmark, map.at(shown))) {
      edit.merges.push_back(merge_of(landmark, map.at(shown)));
    }
  }
  return edit;
}

std::vector<scene::Edit> fuse_around(const MapVersion& map, core::KeyframeId keyframe,
                                     const Config& config, const features::Config& features) {
  const std::vector<core::KeyframeId> neighbours = neighbours_of(map, keyframe, config);
  std::vector<scene::Edit> edits = {
      fuse_into(map, keyframe, landmarks_of(map, neighbours), config, features)};
  MapVersion fused = apply(map, edits.back());
  for (const auto& neighbour : neighbours) {
    edits.push_back(fuse_into(fused, neighbour, landmarks_of(fused, {keyframe}), config, features));
    fused = apply(std::move(fused), edits.back());
  }
  return edits;
}

std::vector<scene::Edit> fuse_across(const MapVersion& map, const scene::LoopEdge& loop,
                                     const Config& config, const features::Config& features) {
  std::vector<core::KeyframeId> there = neighbours_of(map, loop.match, config);
  there.push_back(loop.match);
  std::vector<core::KeyframeId> here = neighbours_of(map, loop.query, config);
  here.insert(here.begin(), loop.query);
  std::vector<scene::Edit> edits;
  MapVersion fused = map;
  for (const auto& keyframe : here) {
    edits.push_back(fuse_into(fused, keyframe, landmarks_of(fused, there), config, features));
    for (auto& merge : edits.back().merges) merge.cause = loop.cause;
    for (auto& sighting : edits.back().sightings) sighting.observation.cause = loop.cause;
    fused = apply(std::move(fused), edits.back());
  }
  return edits;
}

}  // namespace samewhere::map
