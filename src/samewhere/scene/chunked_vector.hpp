#pragma once

#include <algorithm>
#include <array>
#include <memory>
#include <utility>
#include <vector>

#include <samewhere/core/errors.hpp>

namespace samewhere::scene {

// A growing array whose copies share their content: copying costs a pointer per chunk, and writing
// an element copies its chunk only if another copy holds it too. One thread writes (the owner of
// the map); copies may be read and dropped in any thread.
template <class T, std::size_t kChunkSize = 32>
class ChunkedVector {
 public:
  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }

  using Chunk = std::array<T, kChunkSize>;

  const T& operator[](std::size_t i) const {
    core::require(i < size_, "a ChunkedVector is read inside its size");
    return (*chunks_[i / kChunkSize].elements)[i % kChunkSize];
  }
  const T& back() const { return (*this)[size_ - 1]; }

  // The element, to be written.
  T& edit(std::size_t i) {
    core::require(i < size_, "a ChunkedVector is written inside its size");
    Held& chunk = chunks_[i / kChunkSize];
    if (chunk.is_read_only || !is_held_alone(chunk.elements))
      chunk = {std::make_shared<Chunk>(*chunk.elements)};
    return (*chunk.elements)[i % kChunkSize];
  }

  // Elements come in chunks, of which the last may be filled in part.
  std::size_t num_chunks() const { return chunks_.size(); }
  std::shared_ptr<const Chunk> chunk(std::size_t k) const { return chunks_[k].elements; }
  // Where its elements begin and end.
  std::pair<std::size_t, std::size_t> range_of_chunk(std::size_t k) const {
    return {k * kChunkSize, std::min((k + 1) * kChunkSize, size_)};
  }
  // Whether chunk k of both is the same object, and so equal without a comparison.
  bool shares_chunk(const ChunkedVector& other, std::size_t k) const {
    return chunks_[k].elements == other.chunks_[k].elements;
  }

  // Replaces a chunk by equal elements in read-only memory; an edit copies them first.
  void put_read_only(std::size_t k, const std::shared_ptr<Chunk>& elements) {
    chunks_[k] = {elements, true};
  }

  // Drops the elements from `size` on.
  void shrink(std::size_t size) {
    core::require(size <= size_, "a ChunkedVector shrinks to less");
    chunks_.resize((size + kChunkSize - 1) / kChunkSize);
    size_ = size;
  }

  void push_back(T value) {
    if (size_ % kChunkSize == 0) chunks_.push_back({std::make_shared<Chunk>()});
    ++size_;
    edit(size_ - 1) = std::move(value);
  }

 private:
  struct Held {
    std::shared_ptr<Chunk> elements;
    bool is_read_only = false;
  };

  // To look at the count alone would not be enough: taking a share and giving it back makes all
  // that another thread read, before it dropped its own, happen before what is written next.
  static bool is_held_alone(const std::shared_ptr<Chunk>& chunk) {
    constexpr int kOwnAndThis = 2;
    return std::shared_ptr<Chunk>(chunk).use_count() == kOwnAndThis;
  }

  std::vector<Held> chunks_;
  std::size_t size_ = 0;
};

}  // namespace samewhere::scene
