#include <algorithm>
#include <optional>

#include <samewhere/map/cull.hpp>
#include <samewhere/map/seen.hpp>

namespace samewhere::map {
namespace {

using core::KeyframeId;
using scene::Keyframe;
using scene::Landmark;
using scene::MapVersion;

constexpr int kMinExpected = 2;  // keyframes that should see a landmark before it is blamed
constexpr int kEnoughObservers = 3;

bool is_unsupported(const Landmark& landmark) { return landmark.observations.size() == 1; }

// Of the keyframes after its anchor, too few of those that should see the landmark do.
bool is_missed(const MapVersion& map, const Landmark& landmark, const Config& config,
               const features::Config& features) {
  if (static_cast<int>(landmark.observations.size()) >= kEnoughObservers) return false;
  int num_expected = 0;
  int num_found = 0;
  for (std::size_t i = landmark.anchor.index() + 1; i < map.keyframes.size(); ++i) {
    const Keyframe& keyframe = map.keyframes[i];
    if (!is_live(keyframe)) continue;
    const bool is_found = is_seen_by(landmark, keyframe.id);
    num_found += is_found ? 1 : 0;
    num_expected += is_found || expected_at(map, keyframe, landmark, features) ? 1 : 0;
  }
  return num_expected >= kMinExpected && num_found < config.min_found_ratio * num_expected;
}

void cull_landmarks(const MapVersion& map, const Keyframe& anchor, scene::Edit& edit,
                    const Config& config, const features::Config& features) {
  for (const auto& id : anchor.slots) {
    if (!id.is_valid() || map.at(id).anchor != anchor.id) continue;
    if (is_unsupported(map.at(id)) || is_missed(map, map.at(id), config, features))
      edit.culled_landmarks.push_back(id);
  }
}

int octave_of(const MapVersion& map, const scene::Observation& o) {
  return map.at(o.keyframe).view.features->octave[static_cast<std::size_t>(o.slot)];
}

// Whether enough keyframes besides this one see its landmark as finely.
bool is_redundant(const MapVersion& map, const Keyframe& keyframe, std::size_t slot) {
  const int octave = keyframe.view.features->octave[slot];
  int num_others = 0;
  for (const auto& o : map.at(keyframe.slots[slot]).observations) {
    if (o.keyframe == keyframe.id || octave_of(map, o) > octave + 1) continue;
    if (++num_others == kEnoughObservers) return true;
  }
  return false;
}

double redundant_ratio(const MapVersion& map, const Keyframe& keyframe) {
  int num_landmarks = 0;
  int num_redundant = 0;
  for (std::size_t slot = 0; slot < keyframe.slots.size(); ++slot) {
    if (!keyframe.slots[slot].is_valid()) continue;
    ++num_landmarks;
    num_redundant += is_redundant(map, keyframe, slot) ? 1 : 0;
  }
  return num_landmarks > 0 ? static_cast<double>(num_redundant) / num_landmarks : 0.0;
}

bool may_go(const MapVersion& map, const Keyframe& keyframe) {
  return keyframe.odometry.has_value() &&
         std::none_of(map.loops.begin(), map.loops.end(), [&](const scene::LoopEdge& loop) {
           return loop.query == keyframe.id || loop.match == keyframe.id;
         });
}

std::optional<KeyframeId> most_redundant(const MapVersion& map, KeyframeId newest,
                                         const Config& config) {
  std::optional<KeyframeId> most;
  double highest_ratio = config.redundant_ratio;
  for (const auto& covisible : covisible_keyframes(map, newest)) {
    const Keyframe& keyframe = map.at(covisible.keyframe);
    const bool is_late =
        keyframe.id.index() + static_cast<std::size_t>(config.cull_after_keyframes) >=
        newest.index();
    if (is_late || !may_go(map, keyframe)) continue;
    const double ratio = redundant_ratio(map, keyframe);
    if (ratio <= highest_ratio) continue;
    highest_ratio = ratio;
    most = keyframe.id;
  }
  return most;
}

}  // namespace

scene::Edit cull_around(const MapVersion& map, KeyframeId newest, const Config& config,
                        const features::Config& features) {
  scene::Edit edit;
  const auto age = static_cast<std::size_t>(config.cull_after_keyframes);
  if (newest.index() >= age) {
    const Keyframe& anchor = map.keyframes[newest.index() - age];
    if (is_live(anchor)) cull_landmarks(map, anchor, edit, config, features);
  }
  if (const auto keyframe = most_redundant(map, newest, config))
    edit.culled_keyframes.push_back(*keyframe);
  return edit;
}

}  // namespace samewhere::map
