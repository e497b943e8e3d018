#include <cstring>
#include <memory_resource>
#include <utility>

#include <samewhere/features/paged.hpp>

namespace samewhere::features {
namespace {

constexpr std::size_t kAlignment = alignof(std::max_align_t);

template <class Array>
std::size_t bytes_of(const Array& array) {
  return array.size() * sizeof(array[0]) + kAlignment;
}

std::size_t bytes_of(const cv::Mat& bytes) { return bytes.total() + kAlignment; }

std::size_t num_bytes(const Features& f) {
  return bytes_of(f.raw_px) + bytes_of(f.undistorted_px) + bytes_of(f.depth_m) +
         bytes_of(f.right_x_px) + bytes_of(f.octave) + bytes_of(f.angle_rad) + bytes_of(f.rgb) +
         bytes_of(f.descriptors);
}

cv::Mat copy_of(const cv::Mat& bytes, std::pmr::memory_resource& memory) {
  cv::Mat copy(bytes.rows, bytes.cols, CV_8U, memory.allocate(bytes.total(), kAlignment));
  if (!bytes.empty()) bytes.copyTo(copy);  // or the copy loses its number of columns
  return copy;
}

// Features whose arrays lie in one block.
struct Paged {
  explicit Paged(const Features& f, std::shared_ptr<const core::PagedBlock> block)
      : memory(block->bytes().data(), block->bytes().size(), std::pmr::null_memory_resource()),
        features{{f.raw_px, &memory},  {f.undistorted_px, &memory},
                 {f.depth_m, &memory}, {f.right_x_px, &memory},
                 {f.octave, &memory},  {f.angle_rad, &memory},
                 {f.rgb, &memory},     copy_of(f.descriptors, memory),
                 std::move(block)} {}

  std::pmr::monotonic_buffer_resource memory;
  Features features;
};

}  // namespace

std::shared_ptr<const Features> paged(std::shared_ptr<const Features> features,
                                      core::PagedMemory& memory) {
  if (features->pages) return features;
  auto block = memory.allocate(num_bytes(*features));
  if (!block) return features;
  const auto copy = std::make_shared<const Paged>(*features, std::move(block));
  return {copy, &copy->features};
}

void leave_memory(const Features& features) {
  if (features.pages) features.pages->leave_memory();
}

}  // namespace samewhere::features
