#pragma once

#include <optional>
#include <string_view>

namespace samewhere::input {

// What a JPEG file's EXIF data notes. Nothing of it is trusted: damaged data is as none.

// Rotation or mirroring to display the image upright: the EXIF orientation, 2 to 8; 1 if there is
// none or nothing is noted.
int exif_orientation(std::string_view jpeg);

// The focal length of a 35 mm film camera with the same field of view, mm (FocalLengthIn35mmFilm).
// Nothing if it is not there or 0 (unknown).
std::optional<double> focal_length_35mm(std::string_view jpeg);

}  // namespace samewhere::input
