#include <utility>

#include <samewhere/map/full_bundle.hpp>
#include <samewhere/pipeline/full_bundles.hpp>

namespace samewhere::pipeline {

scene::Edit Bundling::answer(const BundleAll& question) {
  const core::ScopedTimer timer(timings_, "full bundle");
  scene::Edit edit = map::full_bundle(question.map, question.window,
                                      {config_.map, config_.features, config_.optimize});
  core::return_free_memory();
  return edit;
}

void FullBundles::note_correction(const scene::MapVersion& map) {
  corrected_at_ = map.keyframes.size();
  if (under_way_) under_way_->counts = false;
}

void FullBundles::forget() {
  corrected_at_.reset();
  if (under_way_) under_way_->counts = false;
}

void FullBundles::begin(const scene::MapVersion& map) {
  if (!corrected_at_ || under_way_) return;
  const auto after = static_cast<std::size_t>(config_.full_bundle_after_keyframes);
  if (map.keyframes.size() >= *corrected_at_ + after) start(map);
}

std::optional<scene::Edit> FullBundles::due(const scene::MapVersion& map) {
  if (!under_way_ || map.keyframes.size() < under_way_->due_at) return std::nullopt;
  return hear(map);
}

std::optional<scene::Edit> FullBundles::last(const scene::MapVersion& map) {
  std::optional<scene::Edit> edit;
  if (under_way_) edit = hear(map);
  if (!corrected_at_ || !start(map)) return edit;
  return hear(map);
}

// False if there is nothing to bundle, or too much.
bool FullBundles::start(const scene::MapVersion& map) {
  corrected_at_.reset();
  map::BundleWindow window = map::window_of_all(map, config_);
  if (window.free.empty()) return false;
  const auto work = static_cast<std::size_t>(map::num_observations(map, window));
  const auto pace = static_cast<std::size_t>(config_.full_bundle_pace);
  under_way_ = {map, map.keyframes.size() + (work + pace - 1) / pace};
  bundling_.send({map, std::move(window)});
  return true;
}

std::optional<scene::Edit> FullBundles::hear(const scene::MapVersion& map) {
  const scene::Edit found = bundling_.receive();
  const UnderWay ended = *std::exchange(under_way_, std::nullopt);
  if (!ended.counts) return std::nullopt;
  return map::carried_over(ended.begun_on, map, found);
}

}  // namespace samewhere::pipeline
