#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <optional>

#include <fcntl.h>
#include <spdlog/spdlog.h>
#include <sys/mman.h>
#include <unistd.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/paged_memory.hpp>

namespace samewhere::core {
namespace {

constexpr std::size_t kFileBytes = std::size_t{16} << 20U;

std::size_t page_bytes() { return static_cast<std::size_t>(sysconf(_SC_PAGESIZE)); }

std::size_t whole_pages(std::size_t size) {
  return (size + page_bytes() - 1) / page_bytes() * page_bytes();
}

std::filesystem::path temporary_folder() {
  const char* told = std::getenv("TMPDIR");
  return told != nullptr && *told != '\0' ? told : "/var/tmp";
}

// Nothing if there is no room. The pages are mapped until the last holder has gone.
std::optional<std::pair<std::shared_ptr<const void>, std::span<std::byte>>> map_new_file(
    std::size_t size) {
  const int file = open(temporary_folder().c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  if (file < 0) return std::nullopt;
  void* begin = MAP_FAILED;
  if (posix_fallocate(file, 0, static_cast<off_t>(size)) == 0)
    begin = mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
  close(file);
  if (begin == MAP_FAILED) return std::nullopt;
  return {{std::shared_ptr<const void>(
               begin, [size](const void* p) { munmap(const_cast<void*>(p), size); }),
           {static_cast<std::byte*>(begin), size}}};
}

}  // namespace

PagedBlock::~PagedBlock() {
  // where the file system knows no holes the pages stay until the file goes
  madvise(bytes_.data(), whole_pages(bytes_.size()), MADV_REMOVE);
}

void PagedBlock::leave_memory() const {
  // what was written stays in the file: its pages are shared with it
  madvise(bytes_.data(), whole_pages(bytes_.size()), MADV_DONTNEED);
}

std::shared_ptr<const PagedBlock> PagedMemory::allocate(std::size_t size) {
  require(size > 0, "a block of memory has bytes");
  const std::size_t needed = whole_pages(size);
  if (free_.size() < needed) {
    if (has_failed_) return nullptr;
    auto mapped = map_new_file(std::max(needed, kFileBytes));
    if (!mapped) {
      has_failed_ = true;
      spdlog::warn("{}: no file can be made there, or it is full; the memory of the map grows",
                   temporary_folder().string());
      return nullptr;
    }
    std::tie(file_, free_) = std::move(*mapped);
  }
  const std::span<std::byte> bytes = free_.first(size);
  free_ = free_.subspan(needed);
  return std::make_shared<PagedBlock>(file_, bytes);
}

}  // namespace samewhere::core
