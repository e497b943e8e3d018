#pragma once

#include <cstdint>
#include <filesystem>

namespace samewhere::input {

// A picture that a header announces, before memory is taken for it. At most 64 megapixels (8-bit
// colour in 192 MiB: a program that holds a few of them stays below 1 GB), and at most 32,767
// pixels a side, as far as OpenCV's remap() counts. Throws InputError naming the file, what the
// header says and the limit; of 0 pixels or fewer, that the file ends before the picture.
void require_reasonable_size(const std::filesystem::path& file, std::int64_t width_px,
                             std::int64_t height_px);

}  // namespace samewhere::input
