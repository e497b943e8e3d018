#pragma once

#include <filesystem>
#include <string_view>

#include <opencv2/core/mat.hpp>

namespace samewhere::input {

// Whether the first bytes of a file are those of a picture that read_image reads.
bool is_picture(std::string_view bytes);

// The picture in a JPEG, PNG, BMP, PNM, TIFF or WebP file (told by its content, not by its name):
// 8-bit BGR, or 8-bit grey if it is stored so, rows x columns. An alpha channel is dropped, 16 bits
// a channel are scaled to 8, inks (CMYK) become colours. Pixels are given as they are stored: a
// rotation noted in EXIF is not applied (exif.hpp), because a calibration refers to the sensor.
// Throws InputError naming the file if it cannot be read, is of another format, is damaged or cut
// short.
cv::Mat read_image(const std::filesystem::path& path);

// The depth in a PNG, PGM or TIFF file with 16-bit grey values: 32-bit float metres = value /
// units_per_m; 0 = unknown, stored as 0 or 65535. A TIFF of 32-bit floats is in metres. Throws
// InputError as above.
cv::Mat read_depth(const std::filesystem::path& path, double units_per_m);

// The same of bytes that were read from elsewhere; messages call them `name`.
cv::Mat decode_image(std::string_view bytes, const std::filesystem::path& name);
cv::Mat decode_depth(std::string_view bytes, const std::filesystem::path& name, double units_per_m);

// Depth in units, 16 bits, or in metres, 32-bit floats, as metres; what is no distance becomes 0.
cv::Mat metres_from_units(const cv::Mat& stored, double units_per_m);
cv::Mat metres_from_floats(cv::Mat depth_m);

}  // namespace samewhere::input
