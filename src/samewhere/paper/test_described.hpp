#pragma once

#include <string>
#include <vector>

#include <samewhere/core/similarity.hpp>
#include <samewhere/paper/described_recording.hpp>
#include <samewhere/pipeline/config.hpp>

namespace samewhere::paper {

// Six made-up views, for tests only. Frames 3, 4, 5 come back to 0, 1, 2. Number 3 looks like 0,
// which is right; number 4 also looks like 0, a bit less, which is wrong and listed as an impostor;
// number 5 looks like 2, still less, which is right. So the precisions at recalls of 1/3, 1/3 and
// 2/3 are 1, 1/2 and 2/3.
inline DescribedRecording second_lap() {
  const std::vector<std::vector<float>> views = {
      {1, 0, 0, 0, 0, 0, 0, 0},   {0, 1, 0, 0, 0, 0, 0, 0},   {0, 0, 1, 0, 0, 0, 0, 0},
      {1, 0, 0, .1F, 0, 0, 0, 0}, {1, 0, 0, 0, .2F, 0, 0, 0}, {0, 0, 1, 0, 0, .3F, 0, 0}};
  DescribedRecording recording{.name = "second lap",
                               .window_frames = 2,
                               .truth = {},
                               .timed_frames = {},
                               .by_describer = {}};
  DescribedViews described{
      .describer = "by hand", .checksum = 0x1234, .views = {}, .durations_ms = {}};
  core::PlaceTruthMatrix places;
  places.num_frames = static_cast<int>(views.size());
  for (std::size_t i = 0; i < views.size(); ++i) {
    described.views.push_back({core::FrameId(i), core::unit(views[i]), 1});
    if (i % 2 == 0) {
      recording.timed_frames.push_back(static_cast<int>(i));
      described.durations_ms.push_back(2.0);
    }
    for (std::size_t j = 0; j < views.size(); ++j) {
      const bool is_same = i == j || i == j + 3;
      places.values.push_back(is_same ? core::PlaceTruth::kSame : core::PlaceTruth::kDifferent);
    }
  }
  recording.truth.places = places;
  recording.truth.impostors = {{4, 0}};
  recording.by_describer.push_back(described);
  return recording;
}

inline constexpr double kSecondLapAuc = 1.0 / 3.0 + (0.5 + 2.0 / 3.0) / 6.0;

// Profile `paper` with a store so small that two groups of two queues hold a lap.
inline pipeline::Config small_store() {
  pipeline::Config config = pipeline::profile("paper");
  config.retrieve.group_size = 2;
  config.retrieve.queue_size = 1;
  config.verify.pause_frames = 0;
  return config;
}

}  // namespace samewhere::paper
