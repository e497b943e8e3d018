#include <algorithm>
#include <cmath>
#include <memory>

#include <opencv2/imgproc.hpp>
#include <turbojpeg.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/report/jpeg.hpp>

namespace samewhere::report {
namespace {

constexpr int kQuality = 82;

struct CloseCompressor {
  void operator()(void* compressor) const { tjDestroy(compressor); }
};
struct FreeBuffer {
  void operator()(unsigned char* buffer) const { tjFree(buffer); }
};

cv::Mat shrunk(const cv::Mat& image, int max_width_px) {
  if (image.cols <= max_width_px) return image;
  const double ratio = static_cast<double>(max_width_px) / image.cols;
  const int height_px = std::max(1, static_cast<int>(std::lround(image.rows * ratio)));
  cv::Mat small;
  cv::resize(image, small, {max_width_px, height_px}, 0.0, 0.0, cv::INTER_AREA);
  return small;
}

}  // namespace

std::string jpeg_bytes(const cv::Mat& image, int max_width_px) {
  const bool is_grey = image.type() == CV_8UC1;
  core::require(!image.empty() && (is_grey || image.type() == CV_8UC3),
                "a thumbnail is an 8-bit grey or BGR picture");
  const cv::Mat small = shrunk(image, max_width_px);

  const std::unique_ptr<void, CloseCompressor> compressor(tjInitCompress());
  unsigned char* buffer = nullptr;
  unsigned long num_bytes = 0;  // NOLINT(google-runtime-int): the library's type
  const int status =
      tjCompress2(compressor.get(), small.data, small.cols, static_cast<int>(small.step),
                  small.rows, is_grey ? TJPF_GRAY : TJPF_BGR, &buffer, &num_bytes,
                  is_grey ? TJSAMP_GRAY : TJSAMP_420, kQuality, 0);
  const std::unique_ptr<unsigned char, FreeBuffer> owner(buffer);
  core::require(status == 0, "a thumbnail can be encoded as JPEG");
  return {reinterpret_cast<const char*>(buffer), num_bytes};
}

std::string base64(std::string_view bytes) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t num_bytes = std::min<std::size_t>(3, bytes.size() - i);
    unsigned group = 0;
    for (std::size_t k = 0; k < 3; ++k)
      group = group << 8 | (k < num_bytes ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      text += k <= num_bytes ? kDigits[group >> (18 - 6 * k) & 63u] : '=';
  }
  return text;
}

std::string jpeg_data_uri(std::string_view jpeg) {
  return "data:image/jpeg;base64," + base64(jpeg);
}

}  // namespace samewhere::report
