#pragma once

#include <filesystem>

#include <opencv2/core/mat.hpp>

namespace samewhere::input {

// The picture in a JPEG or PNG file (told by its content, not by its name): 8-bit BGR, or 8-bit
// grey if it is stored so, rows x columns. An alpha channel is dropped. Pixels are given as they
// are stored: a rotation noted in EXIF is not applied, because a calibration refers to the sensor.
// Throws InputError naming the file if it cannot be read, is of another format, has 16 bits per
// channel, is damaged or cut short.
cv::Mat read_image(const std::filesystem::path& path);

// The depth in a PNG file with 16-bit grey values: 32-bit float metres = value / units_per_m; 0 =
// unknown, stored as 0 or 65535. Throws InputError as above.
cv::Mat read_depth(const std::filesystem::path& path, double units_per_m);

}  // namespace samewhere::input
