#include <algorithm>
#include <cstring>
#include <map>
#include <set>
#include <span>

#include <samewhere/scene/local_map.hpp>

namespace samewhere::scene {
namespace {

// The reference first, then the most covisible keyframes.
std::vector<core::KeyframeId> neighbourhood(const MapVersion& map, core::KeyframeId reference,
                                            int max_neighbours) {
  std::vector<core::KeyframeId> chosen = {reference};
  for (const auto& covisible : covisible_keyframes(map, reference)) {
    if (static_cast<int>(chosen.size()) > max_neighbours) break;
    chosen.push_back(covisible.keyframe);
  }
  return chosen;
}

std::set<core::LandmarkId> shown_by(const MapVersion& map,
                                    std::span<const core::KeyframeId> keyframes) {
  std::set<core::LandmarkId> ids;
  for (const auto& keyframe : keyframes) {
    for (const auto& id : map.at(keyframe).slots) {
      if (id.is_valid()) ids.insert(id);
    }
  }
  return ids;
}

}  // namespace

LocalMap build_local_map(const MapVersion& map, core::KeyframeId reference, Neighbours neighbours) {
  const std::vector<core::KeyframeId> keyframes = neighbourhood(map, reference, neighbours.all);
  const auto middle =
      keyframes.begin() + std::min<std::ptrdiff_t>(neighbours.near + 1, std::ssize(keyframes));
  const std::set<core::LandmarkId> near = shown_by(map, {keyframes.begin(), middle});
  std::vector<core::LandmarkId> ids(near.begin(), near.end());
  for (const core::LandmarkId id : shown_by(map, {middle, keyframes.end()}))
    if (!near.contains(id)) ids.push_back(id);
  const core::Rigid3 reference_from_world = inverse(world_from_body(map, reference));
  LocalMap local;
  local.reference = reference;
  local.num_near = static_cast<int>(near.size());
  local.descriptors = cv::Mat(static_cast<int>(ids.size()), 32, CV_8U);
  for (const auto& id : ids) {
    const Landmark& landmark = map.at(id);
    std::memcpy(local.descriptors.ptr(local.size()), landmark.descriptor.data(),
                landmark.descriptor.size());
    local.landmarks.push_back(id);
    local.points_in_reference.push_back(reference_from_world * position_in_world(map, landmark));
    local.range_m.push_back(landmark.range_m);
    local.octave.push_back(landmark.octave);
  }
  return local;
}

std::optional<core::KeyframeId> keyframe_showing_most(
    const MapVersion& map, const std::vector<core::LandmarkId>& landmarks) {
  std::map<core::KeyframeId, int> num_shown;
  for (const core::LandmarkId landmark : landmarks) {
    const Landmark& shown = survivor_of(map, landmark);
    if (!is_live(shown)) continue;
    for (const auto& observation : shown.observations) ++num_shown[observation.keyframe];
  }
  const auto most =
      std::max_element(num_shown.begin(), num_shown.end(),
                       [](const auto& a, const auto& b) { return a.second < b.second; });
  if (most == num_shown.end()) return std::nullopt;
  return most->first;
}

}  // namespace samewhere::scene
