#pragma once

#include <optional>
#include <string_view>

namespace samewhere::input {

// The focal length that a JPEG's EXIF data gives as that of a 35 mm film camera with the same field
// of view, mm (FocalLengthIn35mmFilm). Nothing if it is not there, is 0 (unknown) or the data is
// damaged.
std::optional<double> focal_length_35mm(std::string_view jpeg);

}  // namespace samewhere::input
