#pragma once

#include <cstddef>
#include <memory>
#include <span>

namespace samewhere::core {

// A piece of a mapped file: it can be paged out at any time and returns when it is read. Its
// destructor frees its space on the disk.
class PagedBlock {
 public:
  // `file` keeps the bytes mapped; they begin at a page and share no page with other blocks.
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

// Allocates blocks in unnamed files in the folder for temporary files ($TMPDIR, otherwise
// /var/tmp). Disk space is reserved at allocation, so that a full disk is reported here and not by
// a later write. A file is removed with its last block, a block's pages with the block.
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
