#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace samewhere::input {

// Natural order: runs of digits count as numbers, so 2.jpg comes before 10.jpg.
bool natural_less(std::string_view a, std::string_view b);

// The last number in the name before its extension, if it has at most nine digits beside zeros that
// lead it: 12 for frame-000012.color.jpg and 00012.png. (A longer one is a stamp or a serial, not a
// count.)
std::optional<int> frame_number(std::string_view name);

// A table of the truth that has the ending of a picture.
inline constexpr std::string_view kSamePlaceTable = "same_place.pgm";

// Whether the name ends as those of pictures do (.jpg, .jpeg, .png, .bmp, .pgm, .ppm, .pnm, .tif,
// .tiff, .webp), in small or capital letters. Names that begin with a dot are no pictures.
bool is_image_name(std::string_view name);

// Whether there is a file or folder (a folder) at that path. No where we may not look. Throws
// InputError for a link that leads nowhere, as core::is_there() does.
bool is_there(const std::filesystem::path& path);
bool is_folder(const std::filesystem::path& path);

// Names of the entries of a folder, in natural order, without those that begin with a dot. Throws
// InputError if it cannot be read.
std::vector<std::string> sorted_names(const std::filesystem::path& folder);

// Of those the pictures: JPEG and PNG, or where there are none of them the other formats. Natural
// order, or by value where all names are decimal numbers (name_stamps.hpp). Throws as above.
std::vector<std::string> picture_names(const std::filesystem::path& folder);

}  // namespace samewhere::input
