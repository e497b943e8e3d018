#pragma once

#include <cstdint>

namespace samewhere::paper {

// How many of `num_wanted` things spread evenly over `num_frames` frames, thing i on frame
// i * num_frames / num_wanted, fall on this one. All of them together are num_wanted.
inline int num_spread_on(int frame, int num_frames, int num_wanted) {
  const auto first_from = [&](std::int64_t from) {
    return (from * num_wanted + num_frames - 1) / num_frames;
  };
  return static_cast<int>(first_from(std::int64_t{frame} + 1) - first_from(frame));
}

}  // namespace samewhere::paper
