#pragma once

#include <cstddef>

#include <opencv2/core/mat.hpp>

namespace samewhere::input {

// What lies between the program and the plugin that reads videos and rarer formats of pictures
// (apps/samewhere-video): the plugin alone links OpenCV's videoio and imgcodecs, which bring
// FFmpeg, GDAL and 57 MB along.

struct VideoPicture {
  cv::Mat image;  // 8-bit BGR, rows x columns; empty: there are no more
  double stamp_s =
      0.0;  // since the beginning of a file, since the start of the machine of a camera
};

class VideoDecoder {
 public:
  VideoDecoder() = default;
  VideoDecoder(const VideoDecoder&) = delete;
  VideoDecoder& operator=(const VideoDecoder&) = delete;
  virtual ~VideoDecoder() = default;

  virtual double frame_rate_hz() const = 0;  // as the file or camera says; 0: it does not
  virtual int num_frames() const = 0;        // as the file says, which may be wrong; 0: it does not
  // By how much a player turns the pictures, as the file says, 0, 90, 180 or 270; next() does not.
  virtual int rotation_degrees() const = 0;
  virtual VideoPicture next() = 0;
};

// A function of the plugin: a file, or a camera's device. Nothing if it cannot be read.
using OpenVideo = VideoDecoder*(const char* path, bool is_camera);
inline constexpr const char* kOpenVideoSymbol = "samewhere_open_video";

// The other: the picture in the bytes of a file, as it is stored. False if there is none.
using DecodePicture = bool(const unsigned char* bytes, std::size_t num_bytes, cv::Mat& image);
inline constexpr const char* kDecodePictureSymbol = "samewhere_decode_picture";

}  // namespace samewhere::input
