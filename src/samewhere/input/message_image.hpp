#pragma once

#include <optional>
#include <string>

#include <opencv2/core/mat.hpp>
#include <opencv2/core/types.hpp>

#include <samewhere/core/rig.hpp>
#include <samewhere/messages/messages.hpp>

namespace samewhere::input {

// Pictures, depth and calibrations of ROS messages. All throw InputError, in which `name` stands
// for the message: a topic with a stamp.

// 8-bit grey or BGR, rows x columns, from mono8, mono16, 8UC1, 8UC3, 16UC1 as grey, bgr8, rgb8,
// bgra8, rgba8, yuv422 (also yuv422_yuy2, uyvy, yuyv), bayer_rggb8 and the other three, also of 16
// bits. What has 16 bits is scaled to 8.
cv::Mat image_of(const messages::Image& message, const std::string& name);
// From the bytes of a JPEG, PNG or another picture (image_file.hpp).
cv::Mat image_of(const messages::CompressedImage& message, const std::string& name);

// Whether a picture of this encoding holds depth: 16UC1, 32FC1, mono16 of a topic that says so.
bool is_depth_encoding(const std::string& encoding);
// Whether this format is that of depth: "16UC1; compressedDepth".
bool is_depth_format(const std::string& format);

// 32-bit float metres, 0 = unknown, from 16UC1 (units_per_m, 1000 by REP-118) or 32FC1 (metres).
cv::Mat depth_of(const messages::Image& message, const std::string& name, double units_per_m);
// From compressedDepth: a PNG behind twelve bytes, of 16UC1, or of 32FC1 as quantized inverse
// depth. Or from a PNG of 16 bits alone.
cv::Mat depth_of(const messages::CompressedImage& message, const std::string& name,
                 double units_per_m);

// The camera of a picture of that size. Nothing if the message has no calibration (K of zeros).
// distortion_model: plumb_bob, rational_polynomial, equidistant (also "fisheye"), or none.
// `is_rectified`: the picture is the rectified one, of which P tells. Binning and region of
// interest are taken into account.
std::optional<core::Camera> camera_of(const messages::CameraInfo& info, bool is_rectified,
                                      const std::string& name);

// The calibration of a camera that is not rectified as a message, without its header.
messages::CameraInfo camera_info_of(const core::Camera& camera);

}  // namespace samewhere::input
