#include <cmath>
#include <cstdint>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include <samewhere/core/errors.hpp>
#include <samewhere/library/pictures.hpp>

namespace samewhere::library {
namespace {

struct Layout {
  int type = CV_8UC1;  // of OpenCV
  std::size_t bytes_per_pixel = 1;
  bool is_depth = false;
  std::string_view name;
};

Layout layout_of(PixelFormat format) {
  switch (format) {
    case PixelFormat::kGray8:
      return {CV_8UC1, 1, false, "gray8"};
    case PixelFormat::kBgr8:
      return {CV_8UC3, 3, false, "bgr8"};
    case PixelFormat::kRgb8:
      return {CV_8UC3, 3, false, "rgb8"};
    case PixelFormat::kBgra8:
      return {CV_8UC4, 4, false, "bgra8"};
    case PixelFormat::kDepth16:
      return {CV_16UC1, 2, true, "depth16"};
    case PixelFormat::kDepthFloat:
      return {CV_32FC1, 4, true, "depth in float metres"};
  }
  throw core::InputError(fmt::format("image: format {} is none; expected one of PixelFormat",
                                     static_cast<int>(format)));
}

// Not copied; OpenCV takes no const data.
cv::Mat wrapped(const Image& image) {
  constexpr std::size_t kNoGap = cv::Mat::AUTO_STEP;
  const std::size_t stride = image.stride_bytes == 0 ? kNoGap : image.stride_bytes;
  return {image.height_px, image.width_px, layout_of(image.format).type,
          const_cast<void*>(image.data), stride};
}

float known_or_zero(float depth_m) {
  return std::isfinite(depth_m) && depth_m > 0.0F ? depth_m : 0.0F;
}

}  // namespace

void check_image(const std::string& name, const Image& image, bool is_depth) {
  const Layout layout = layout_of(image.format);
  if (image.data == nullptr)
    throw core::InputError(name + ": has no data; expected a pointer to its first row");
  if (layout.is_depth != is_depth) {
    throw core::InputError(
        fmt::format("{}: format {}; expected {}", name, layout.name,
                    is_depth ? "depth16 or depth in float metres" : "gray8, bgr8, rgb8 or bgra8"));
  }
  if (image.width_px <= 0 || image.height_px <= 0) {
    throw core::InputError(fmt::format("{}: {} x {} pixels; expected at least one", name,
                                       image.width_px, image.height_px));
  }
  const std::size_t row = static_cast<std::size_t>(image.width_px) * layout.bytes_per_pixel;
  if (image.stride_bytes != 0 && image.stride_bytes < row) {
    throw core::InputError(
        fmt::format("{}: stride of {} bytes; expected at least {}", name, image.stride_bytes, row));
  }
  if (image.format == PixelFormat::kDepth16 && !(image.depth_units_per_m > 0.0)) {
    throw core::InputError(fmt::format("{}: {} depth units per metre; expected more than 0", name,
                                       image.depth_units_per_m));
  }
}

cv::Mat picture_of(const Image& image) {
  cv::Mat picture;
  if (image.format == PixelFormat::kRgb8) {
    cv::cvtColor(wrapped(image), picture, cv::COLOR_RGB2BGR);
  } else if (image.format == PixelFormat::kBgra8) {
    cv::cvtColor(wrapped(image), picture, cv::COLOR_BGRA2BGR);
  } else {
    picture = wrapped(image).clone();
  }
  return picture;
}

cv::Mat depth_of(const Image& image) {
  constexpr std::uint16_t kUnknown = 0xffff;
  const cv::Mat given = wrapped(image);
  cv::Mat depth_m(given.size(), CV_32FC1);
  for (int y = 0; y < given.rows; ++y) {
    auto* out = depth_m.ptr<float>(y);
    for (int x = 0; x < given.cols; ++x) {
      if (image.format == PixelFormat::kDepthFloat) {
        out[x] = known_or_zero(given.at<float>(y, x));
        continue;
      }
      const auto units = given.at<std::uint16_t>(y, x);
      out[x] = units == kUnknown ? 0.0F : static_cast<float>(units / image.depth_units_per_m);
    }
  }
  return depth_m;
}

}  // namespace samewhere::library
