#pragma once

#include <array>
#include <memory>
#include <vector>

#include <samewhere/core/errors.hpp>

namespace samewhere::scene {

// A growing array whose copies share their content: copying costs a pointer per chunk, and writing
// an element copies its chunk only if another copy holds it too. One thread writes (the owner of
// the map); copies may be read and dropped anywhere.
template <class T, std::size_t kChunkSize = 32>
class ChunkedVector {
 public:
  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }

  const T& operator[](std::size_t i) const {
    core::require(i < size_, "a ChunkedVector is read inside its size");
    return (*chunks_[i / kChunkSize])[i % kChunkSize];
  }
  const T& back() const { return (*this)[size_ - 1]; }

  // The element, to be written.
  T& edit(std::size_t i) {
    core::require(i < size_, "a ChunkedVector is written inside its size");
    auto& chunk = chunks_[i / kChunkSize];
    if (chunk.use_count() > 1) chunk = std::make_shared<Chunk>(*chunk);
    return (*chunk)[i % kChunkSize];
  }

  void push_back(T value) {
    if (size_ % kChunkSize == 0) chunks_.push_back(std::make_shared<Chunk>());
    ++size_;
    edit(size_ - 1) = std::move(value);
  }

 private:
  using Chunk = std::array<T, kChunkSize>;
  std::vector<std::shared_ptr<Chunk>> chunks_;
  std::size_t size_ = 0;
};

}  // namespace samewhere::scene
