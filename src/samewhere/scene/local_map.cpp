#include <algorithm>
#include <cstring>
#include <map>
#include <set>

#include <samewhere/scene/local_map.hpp>

namespace samewhere::scene {
namespace {

// The reference first, then who shares most; ties go to the younger keyframe.
std::vector<core::KeyframeId> neighbourhood(const MapVersion& map, core::KeyframeId reference,
                                            int max_neighbours) {
  std::map<core::KeyframeId, int> shared;
  for (const core::LandmarkId id : map.at(reference).slots) {
    if (!id.is_valid()) continue;
    for (const auto& observation : map.at(id).observations) ++shared[observation.keyframe];
  }
  shared.erase(reference);
  std::vector<std::pair<int, core::KeyframeId>> ranked;
  for (const auto& [keyframe, count] : shared) ranked.emplace_back(count, keyframe);
  std::sort(ranked.rbegin(), ranked.rend());

  std::vector<core::KeyframeId> chosen = {reference};
  for (const auto& [count, keyframe] : ranked) {
    if (static_cast<int>(chosen.size()) > max_neighbours) break;
    chosen.push_back(keyframe);
  }
  return chosen;
}

}  // namespace

LocalMap build_local_map(const MapVersion& map, core::KeyframeId reference, int max_neighbours) {
  std::set<core::LandmarkId> ids;
  for (const auto& keyframe : neighbourhood(map, reference, max_neighbours)) {
    for (const auto& id : map.at(keyframe).slots) {
      if (id.is_valid()) ids.insert(id);
    }
  }
  const core::Rigid3 reference_from_world = inverse(map.at(reference).world_from_body);
  LocalMap local;
  local.reference = reference;
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

}  // namespace samewhere::scene
