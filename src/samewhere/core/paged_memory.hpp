#pragma once

#include <cstddef>
#include <memory>
#include <span>

namespace samewhere::core {

// A piece of a mapped file: it may leave memory at any moment, and comes back where it is read.
// When it goes its place on the disk is free again.
class PagedBlock {
 public:
  // `file` keeps the bytes mapped; they begin at a page, and nobody else has any of their pages.
  PagedBlock(std::shared_ptr<const void> file, std::span<std::byte> bytes)
      : file_(std::move(file)), bytes_(bytes) {}
  PagedBlock(const PagedBlock&) = delete;
  PagedBlock& operator=(const PagedBlock&) = delete;
  ~PagedBlock();

  std::span<std::byte> bytes() const { return bytes_; }
  // Out of the memory of this process. In any thread, also while another one reads.
  void leave_memory() const;

 private:
  std::shared_ptr<const void> file_;
  std::span<std::byte> bytes_;
};

// Hands out blocks of files without a name in the folder for temporary files ($TMPDIR, otherwise
// /var/tmp). Space is reserved on the disk before it is handed out, so that a full disk is told
// here and not where somebody writes. A file goes when its last block does, a block's pages when it
// does.
class PagedMemory {
 public:
  // `size` > 0 bytes, beginning at a page. Nothing if the folder cannot be written or is full; then
  // ordinary memory has to do. That is told once, as a warning, and not tried again.
  std::shared_ptr<const PagedBlock> allocate(std::size_t size);

 private:
  std::shared_ptr<const void> file_;
  std::span<std::byte> free_;
  bool has_failed_ = false;
};

}  // namespace samewhere::core
