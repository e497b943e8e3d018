#pragma once

#include <array>
#include <memory>
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

  const T& operator[](std::size_t i) const {
    core::require(i < size_, "a ChunkedVector is read inside its size");
    return (*chunks_[i / kChunkSize])[i % kChunkSize];
  }
  const T& back() const { return (*this)[size_ - 1]; }

  // Whether element i of both is one and the same, and so equal without a look at it.
  bool shares_memory(const ChunkedVector& other, std::size_t i) const {
    return &(*this)[i] == &other[i];
  }

  // The element, to be written.
  T& edit(std::size_t i) {
    core::require(i < size_, "a ChunkedVector is written inside its size");
    auto& chunk = chunks_[i / kChunkSize];
    if (!is_held_alone(chunk)) chunk = std::make_shared<Chunk>(*chunk);
    return (*chunk)[i % kChunkSize];
  }

  // Drops the elements from `size` on.
  void shrink(std::size_t size) {
    core::require(size <= size_, "a ChunkedVector shrinks to less");
    chunks_.resize((size + kChunkSize - 1) / kChunkSize);
    size_ = size;
  }

  void push_back(T value) {
    if (size_ % kChunkSize == 0) chunks_.push_back(std::make_shared<Chunk>());
    ++size_;
    edit(size_ - 1) = std::move(value);
  }

 private:
  using Chunk = std::array<T, kChunkSize>;

  // To look at the count alone would not be enough: taking a share and giving it back makes all
  // that another thread read, before it dropped its own, happen before what is written next.
  static bool is_held_alone(const std::shared_ptr<Chunk>& chunk) {
    constexpr int kOwnAndThis = 2;
    return std::shared_ptr<Chunk>(chunk).use_count() == kOwnAndThis;
  }

  std::vector<std::shared_ptr<Chunk>> chunks_;
  std::size_t size_ = 0;
};

}  // namespace samewhere::scene
