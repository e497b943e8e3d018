#include <algorithm>
#include <cstddef>
#include <cstdint>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/similarity.hpp>
#include <samewhere/retrieve/segmented_store.hpp>

namespace samewhere::retrieve {

SegmentedStore::SegmentedStore(int group_size, int queue_size)
    : group_size_(group_size), queue_size_(queue_size) {
  core::require(queue_size > 0 && group_size > 0 && group_size % queue_size == 0,
                "a group of the store is a whole number of queues");
}

void SegmentedStore::append(core::FrameId frame, std::span<const float> vector) {
  core::require(frame.is_valid(), "a stored view has a frame");
  core::require(frames_.empty() || frames_.back() < frame, "views are stored in frame order");
  core::require(!vector.empty(), "a stored vector has elements");
  if (frames_.empty()) vector_length_ = static_cast<int>(vector.size());
  core::require(vector.size() == static_cast<std::size_t>(vector_length_),
                "stored vectors have one length");
  if (num_vectors() % group_size_ == 0) {
    groups_.emplace_back().reserve(static_cast<std::size_t>(group_size_) * vector.size());
  }
  groups_.back().insert(groups_.back().end(), vector.begin(), vector.end());
  inverse_deviations_.push_back(core::inverse_deviation(vector));
  frames_.push_back(frame);
}

std::span<const float> SegmentedStore::vector(int position) const {
  const auto length = static_cast<std::size_t>(vector_length_);
  const auto& group = groups_[static_cast<std::size_t>(position / group_size_)];
  return std::span(group).subspan(static_cast<std::size_t>(position % group_size_) * length,
                                  length);
}

PositionRange SegmentedStore::queue(int group, int queue) const {
  const int begin = group * group_size_ + queue * queue_size_;
  return {std::min(begin, num_vectors()), std::min(begin + queue_size_, num_vectors())};
}

int SegmentedStore::num_older(core::FrameId frame, int window_frames) const {
  const auto window = static_cast<std::uint64_t>(window_frames);
  const auto is_older = [&](core::FrameId stored) {
    if (stored.session() != frame.session()) return stored.session() < frame.session();
    return stored.index() + window < frame.index();
  };
  // frames ascend, so the older ones come first
  const auto first_recent = std::partition_point(frames_.begin(), frames_.end(), is_older);
  return static_cast<int>(first_recent - frames_.begin());
}

}  // namespace samewhere::retrieve
