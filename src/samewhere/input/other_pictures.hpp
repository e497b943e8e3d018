#pragma once

#include <filesystem>
#include <string_view>

#include <opencv2/core/mat.hpp>

namespace samewhere::input {

// Formats of pictures beside JPEG and PNG: BMP, PNM (PBM, PGM, PPM), TIFF and WebP. They are
// decoded by OpenCV's imgcodecs, which the plugin for videos links (video_decoder.hpp).

// Told by its first bytes.
bool is_other_picture(std::string_view bytes);

// The picture as it is stored: 8 or 16 bits or floats, one to four channels, blue first. Its size
// is checked by the header before memory is taken. Throws InputError naming the file if it is
// damaged, of a kind that is not read, or too large, or if the plugin is missing.
cv::Mat decode_other_picture(const std::filesystem::path& file, std::string_view bytes);

}  // namespace samewhere::input
