#pragma once

#include <span>
#include <vector>

#include <samewhere/core/ids.hpp>

namespace samewhere::retrieve {

// Positions begin, begin + 1, ..., end - 1 of the store.
struct PositionRange {
  int begin = 0;
  int end = 0;
};

// The vectors of all views so far in the order of their frames, laid out as the published method
// draws them: groups of `group_size` vectors, each group of queues of `queue_size` consecutive ones
// (100 and 10). A group is one block of memory (100 vectors of 1260 floats: 504 kB) that never
// moves, so appending costs one copy of the vector whatever the size of the store.
// Memory per view: 4 bytes per number and 12 more (5052 bytes for 1260 numbers, 505 MB for 100,000
// views); the last group is reserved whole.
class SegmentedStore {
 public:
  // group_size is a positive multiple of queue_size, or ContractError.
  SegmentedStore(int group_size, int queue_size);

  // Frames ascend strictly and all vectors have the length of the first, or ContractError.
  void append(core::FrameId frame, std::span<const float> vector);

  int num_vectors() const { return static_cast<int>(frames_.size()); }
  int num_groups() const { return static_cast<int>(groups_.size()); }  // ceil(M / group_size)
  int queues_per_group() const { return group_size_ / queue_size_; }
  int vector_length() const { return vector_length_; }  // 0 while empty

  // Position is in [0, num_vectors()): 0 is the oldest.
  core::FrameId frame(int position) const { return frames_[static_cast<std::size_t>(position)]; }
  std::span<const float> vector(int position) const;
  // core::inverse_deviation of the vector, computed once, for the exact similarity.
  float inverse_deviation(int position) const {
    return inverse_deviations_[static_cast<std::size_t>(position)];
  }
  // Group and queue count from 0. Shorter or empty where the store has not got so far.
  PositionRange queue(int group, int queue) const;
  // How many stored frames are more than window_frames older than `frame`: exactly positions
  // 0 .. n - 1. A frame of an earlier session is older than any window.
  int num_older(core::FrameId frame, int window_frames) const;

 private:
  int group_size_;
  int queue_size_;
  int vector_length_ = 0;
  std::vector<core::FrameId> frames_;
  std::vector<float> inverse_deviations_;
  std::vector<std::vector<float>> groups_;
};

}  // namespace samewhere::retrieve
