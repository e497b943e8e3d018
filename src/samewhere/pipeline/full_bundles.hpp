#pragma once

#include <cstddef>
#include <optional>

#include <samewhere/core/timing.hpp>
#include <samewhere/pipeline/config.hpp>
#include <samewhere/pipeline/messages.hpp>

namespace samewhere::pipeline {

// The fourth stage, asked by mapping now and then: where would everything fit best?
class Bundling {
 public:
  explicit Bundling(const Config& config) : config_(config) {}

  scene::Edit answer(const BundleAll& question);

  const core::Timings& timings() const { return timings_; }

 private:
  Config config_;
  core::Timings timings_;
};

// When all of the map is bundled, and whether it counts: some keyframes after loops corrected the
// map, with an answer that is due after as many keyframes as it has work for, never sooner or
// later. A correction before that makes it void.
class FullBundles {
 public:
  // `bundling` outlives this.
  FullBundles(const map::Config& config, BundleLink& bundling)
      : config_(config), bundling_(bundling) {}
  FullBundles(const FullBundles&) = delete;
  FullBundles& operator=(const FullBundles&) = delete;

  // Loops have moved the map.
  void note_correction(const scene::MapVersion& map);
  // The map is re-initialized.
  void forget();
  // Begins what is called for, if it is time.
  void begin(const scene::MapVersion& map);
  // What is due by now, for the map as it is.
  std::optional<scene::Edit> due(const scene::MapVersion& map);
  // What is under way or still to be begun, at the end: waits for it.
  std::optional<scene::Edit> last(const scene::MapVersion& map);

 private:
  struct UnderWay {
    scene::MapVersion begun_on;
    std::size_t due_at = 0;  // keyframes of the map
    bool counts = true;
  };

  bool start(const scene::MapVersion& map);
  std::optional<scene::Edit> hear(const scene::MapVersion& map);

  map::Config config_;
  BundleLink& bundling_;
  std::optional<UnderWay> under_way_;
  std::optional<std::size_t> corrected_at_;  // keyframes then; none: nothing is called for
};

}  // namespace samewhere::pipeline
