#pragma once

#include <string_view>

namespace samewhere::input {

// How a JPEG file notes that it is to be turned or mirrored before a person looks at it: the EXIF
// orientation, 2 to 8; 1 if it does not, or if nothing is noted.
int exif_orientation(std::string_view bytes);

}  // namespace samewhere::input
