#include <set>
#include <utility>

#include <samewhere/correct/loop_corrector.hpp>
#include <samewhere/map/local_bundle.hpp>
#include <samewhere/map/part.hpp>
#include <samewhere/pipeline/withdrawal.hpp>

namespace samewhere::pipeline {
namespace {

using scene::MapVersion;

std::set<core::KeyframeId> keyframes_that_show_something_else(const MapVersion& before,
                                                              const MapVersion& after) {
  std::set<core::KeyframeId> changed;
  for (std::size_t i = 0; i < before.keyframes.size(); ++i) {
    const scene::Keyframe& keyframe = after.keyframes[i];
    if (is_live(keyframe) && keyframe.slots != before.keyframes[i].slots)
      changed.insert(keyframe.id);
  }
  return changed;
}

// Each in one bundle, as a free one.
MapVersion bundled(MapVersion map, std::set<core::KeyframeId> keyframes, const Config& config) {
  while (!keyframes.empty()) {
    const core::KeyframeId keyframe = *keyframes.begin();
    keyframes.erase(keyframe);
    for (const auto& free : map::window_around(map, keyframe, config.map).free)
      keyframes.erase(free);
    const auto edit =
        map::bundle_around(map, keyframe, {config.map, config.features, config.optimize});
    map = apply(std::move(map), edit);
  }
  return map;
}

}  // namespace

MapVersion with_places_parted(const MapVersion& before, MapVersion after, const Config& config) {
  for (const auto& edit : map::part_places(before, after, config.features))
    after = apply(std::move(after), edit);
  after = bundled(after, keyframes_that_show_something_else(before, after), config);
  const scene::Edit poses = correct::solve_poses(after, config.optimize);
  return apply(std::move(after), poses);
}

MapVersion without_loop(const MapVersion& map, core::CandidateId cause, const Config& config) {
  const auto edit = correct::withdraw_loop(map, cause, config.optimize);
  return with_places_parted(map, apply(map, edit), config);
}

}  // namespace samewhere::pipeline
