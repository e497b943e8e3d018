// The plugin that reads videos and cameras, by OpenCV's videoio, and the rarer formats of pictures,
// by its imgcodecs: see input/video_decoder.hpp.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <memory>

#include <opencv2/core/utils/logger.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>

#include <samewhere/input/video_decoder.hpp>

namespace samewhere::input {
namespace {

double seconds_since_start_of_machine() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

class OpencvDecoder : public VideoDecoder {
 public:
  OpencvDecoder(const char* path, bool is_camera) : is_camera_(is_camera) {
    capture_.open(path, is_camera ? cv::CAP_V4L2 : cv::CAP_FFMPEG);
    // a calibration belongs to the sensor, however the telephone was held
    capture_.set(cv::CAP_PROP_ORIENTATION_AUTO, 0.0);
  }

  bool is_open() const { return capture_.isOpened(); }

  double frame_rate_hz() const override { return std::max(capture_.get(cv::CAP_PROP_FPS), 0.0); }

  int num_frames() const override {
    constexpr double kMost = 1e9;
    return static_cast<int>(std::clamp(capture_.get(cv::CAP_PROP_FRAME_COUNT), 0.0, kMost));
  }

  int rotation_degrees() const override {
    const auto degrees = static_cast<int>(std::lround(capture_.get(cv::CAP_PROP_ORIENTATION_META)));
    return degrees == 90 || degrees == 180 || degrees == 270 ? degrees : 0;
  }

  VideoPicture next() override {
    VideoPicture picture;
    if (!capture_.read(picture.image)) return {};
    picture.image = picture.image.clone();  // the buffer is used again
    picture.stamp_s = capture_.get(cv::CAP_PROP_POS_MSEC) / 1000.0;
    if (is_camera_ && picture.stamp_s <= 0.0) picture.stamp_s = seconds_since_start_of_machine();
    return picture;
  }

 private:
  bool is_camera_;
  cv::VideoCapture capture_;
};

// While it lives, std::cerr says nothing: what is wrong is told in one line, by the caller.
class QuietErrors {
 public:
  QuietErrors() : buffer_(std::cerr.rdbuf(nullptr)) {}
  QuietErrors(const QuietErrors&) = delete;
  QuietErrors& operator=(const QuietErrors&) = delete;
  ~QuietErrors() {
    std::cerr.rdbuf(buffer_);
    std::cerr.clear();
  }

 private:
  std::streambuf* buffer_;
};

}  // namespace
}  // namespace samewhere::input

extern "C" samewhere::input::VideoDecoder* samewhere_open_video(const char* path, bool is_camera) {
  // what is wrong is told in one line, by the caller
  cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
  constexpr const char* kQuiet = "-8";  // AV_LOG_QUIET
  setenv("OPENCV_FFMPEG_LOGLEVEL", kQuiet, 0);
  // a playlist that has the name of a video must not fetch from elsewhere
  setenv("OPENCV_FFMPEG_CAPTURE_OPTIONS", "protocol_whitelist;file", 0);
  auto decoder = std::make_unique<samewhere::input::OpencvDecoder>(path, is_camera);
  return decoder->is_open() ? decoder.release() : nullptr;
}

extern "C" bool samewhere_decode_picture(const unsigned char* bytes, std::size_t num_bytes,
                                         cv::Mat& image) {
  cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
  const samewhere::input::QuietErrors quiet;
  try {
    const cv::Mat encoded(1, static_cast<int>(num_bytes), CV_8UC1,
                          const_cast<unsigned char*>(bytes));  // NOLINT: it is only read
    image = cv::imdecode(encoded, cv::IMREAD_UNCHANGED);
  } catch (const cv::Exception&) {
    return false;
  }
  return !image.empty();
}
