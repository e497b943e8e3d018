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

bool has_depth(const MapVersion& map, const scene::Observation& observation) {
  return map.at(observation.keyframe)
             .view.features->depth_m[static_cast<std::size_t>(observation.slot)] > 0.0F;
}

bool is_seen_once(const Landmark& landmark) { return landmark.observations.size() == 1; }

bool is_unsupported(const MapVersion& map, const Landmark& landmark) {
  return is_seen_once(landmark) && !has_depth(map, landmark.observations[0]);
}

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

// The keyframe that was added so many before the newest; nothing if it is gone or never was.
const Keyframe* of_age(const MapVersion& map, KeyframeId newest, int num_keyframes) {
  const auto age = static_cast<std::size_t>(num_keyframes);
  if (newest.index() < age) return nullptr;
  const Keyframe& keyframe = map.keyframes[newest.index() - age];
  return is_live(keyframe) ? &keyframe : nullptr;
}

// Those that hang on the keyframe of this age and are no good.
template <class IsBad>
void cull_landmarks(const MapVersion& map, const Keyframe* anchor, scene::Edit& edit,
                    const IsBad& is_bad) {
  if (anchor == nullptr) return;
  for (const auto& id : anchor->slots) {
    if (id.is_valid() && map.at(id).anchor == anchor->id && is_bad(map.at(id)))
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
  cull_landmarks(
      map, of_age(map, newest, config.cull_after_keyframes), edit, [&](const Landmark& landmark) {
        return is_unsupported(map, landmark) || is_missed(map, landmark, config, features);
      });
  cull_landmarks(map, of_age(map, newest, config.cull_unmatched_after_keyframes), edit,
                 is_seen_once);
  if (const auto keyframe = most_redundant(map, newest, config))
    edit.culled_keyframes.push_back(*keyframe);
  return edit;
}

}  // namespace samewhere::map
