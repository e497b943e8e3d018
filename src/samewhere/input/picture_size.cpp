#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/input/picture_size.hpp>

namespace samewhere::input {

void require_reasonable_size(const std::filesystem::path& file, std::int64_t width_px,
                             std::int64_t height_px) {
  constexpr std::int64_t kMaxPixels = 64'000'000;
  constexpr std::int64_t kMaxSide_px = 32'767;
  if (width_px < 1 || height_px < 1) {
    throw core::InputError(file.string() + ": damaged image file: it ends before the picture");
  }
  if (width_px <= kMaxSide_px && height_px <= kMaxSide_px && width_px * height_px <= kMaxPixels)
    return;
  throw core::InputError(
      fmt::format("{}: is {} x {} pixels by its header, expected at most {} megapixels and {} "
                  "pixels a side, so that a damaged header cannot take all memory",
                  file.string(), width_px, height_px, kMaxPixels / 1'000'000, kMaxSide_px));
}

}  // namespace samewhere::input
