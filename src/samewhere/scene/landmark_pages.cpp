#include <algorithm>
#include <cstddef>
#include <new>

#include <samewhere/scene/landmark_pages.hpp>

namespace samewhere::scene {
namespace {

using Chunk = ChunkedVector<Landmark>::Chunk;

constexpr std::size_t kAlignment = alignof(std::max_align_t);
static_assert(alignof(Chunk) <= kAlignment && alignof(Observation) <= kAlignment);

// A chunk and what its landmarks hold, in one block.
class PagedChunk {
 public:
  PagedChunk(const Chunk& chunk, std::shared_ptr<const core::PagedBlock> block)
      : block_(std::move(block)),
        memory_(block_->bytes().data(), block_->bytes().size(), std::pmr::null_memory_resource()),
        chunk_(static_cast<Chunk*>(memory_.allocate(sizeof(Chunk), kAlignment))) {
    for (std::size_t i = 0; i < chunk.size(); ++i) {
      Landmark* landmark = std::construct_at(chunk_->data() + i, chunk[i]);
      // a vector keeps the memory that it was made with
      std::destroy_at(&landmark->observations);
      std::construct_at(&landmark->observations, chunk[i].observations, &memory_);
    }
  }
  // Nothing is destroyed: all that the landmarks hold is in the block, and goes with it.

  Chunk& chunk() { return *chunk_; }

  static std::size_t num_bytes(const Chunk& chunk) {
    std::size_t sum = sizeof(Chunk) + kAlignment;
    for (const Landmark& landmark : chunk)
      sum += landmark.observations.size() * sizeof(Observation) + kAlignment;
    return sum;
  }

 private:
  std::shared_ptr<const core::PagedBlock> block_;
  std::pmr::monotonic_buffer_resource memory_;
  Chunk* chunk_;
};

}  // namespace

void LandmarkPages::step(ChunkedVector<Landmark>& landmarks, std::size_t num_steps) {
  const std::size_t num_full = landmarks.size() / std::tuple_size_v<Chunk>;
  seen_.resize(num_full);
  // where there are fewer chunks than steps, some steps visit none
  const std::size_t num_in_round = std::max<std::size_t>(num_steps, 1);
  for (due_ += num_full; due_ >= num_in_round && num_full > 0; due_ -= num_in_round) {
    next_ = next_ < num_full ? next_ : 0;
    visit(landmarks, next_++);
  }
}

void LandmarkPages::visit(ChunkedVector<Landmark>& landmarks, std::size_t k) {
  Seen& seen = seen_[k];
  const std::shared_ptr<const Chunk> now = landmarks.chunk(k);
  if (now != seen.chunk) {
    seen = {now, nullptr};
    return;
  }
  if (!seen.pages) {
    seen.pages = memory_.allocate(PagedChunk::num_bytes(*now));
    if (!seen.pages) return;
    const auto paged = std::make_shared<PagedChunk>(*now, seen.pages);
    const std::shared_ptr<Chunk> chunk(paged, &paged->chunk());
    landmarks.put_read_only(k, chunk);
    seen.chunk = chunk;
  }
  seen.pages->leave_memory();
}

}  // namespace samewhere::scene
