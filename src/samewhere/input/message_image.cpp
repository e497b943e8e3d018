#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include <samewhere/core/errors.hpp>
#include <samewhere/geometry/camera_check.hpp>
#include <samewhere/input/image_file.hpp>
#include <samewhere/input/message_image.hpp>
#include <samewhere/input/picture_size.hpp>

namespace samewhere::input {
namespace {

using core::InputError;

// How an encoding is stored, and what turns it into grey or BGR; -1: nothing to do.
struct Encoding {
  std::string_view name;
  int type = CV_8UC1;
  int conversion = -1;
};

// OpenCV names a Bayer pattern by its second row, ROS by its first.
constexpr std::array kEncodings = {
    Encoding{"mono8", CV_8UC1},
    Encoding{"8UC1", CV_8UC1},
    Encoding{"mono16", CV_16UC1},
    Encoding{"16UC1", CV_16UC1},
    Encoding{"bgr8", CV_8UC3},
    Encoding{"8UC3", CV_8UC3},
    Encoding{"rgb8", CV_8UC3, cv::COLOR_RGB2BGR},
    Encoding{"bgra8", CV_8UC4, cv::COLOR_BGRA2BGR},
    Encoding{"8UC4", CV_8UC4, cv::COLOR_BGRA2BGR},
    Encoding{"rgba8", CV_8UC4, cv::COLOR_RGBA2BGR},
    Encoding{"bgr16", CV_16UC3},
    Encoding{"rgb16", CV_16UC3, cv::COLOR_RGB2BGR},
    Encoding{"yuv422", CV_8UC2, cv::COLOR_YUV2BGR_UYVY},
    Encoding{"uyvy", CV_8UC2, cv::COLOR_YUV2BGR_UYVY},
    Encoding{"yuv422_yuy2", CV_8UC2, cv::COLOR_YUV2BGR_YUY2},
    Encoding{"yuyv", CV_8UC2, cv::COLOR_YUV2BGR_YUY2},
    Encoding{"bayer_rggb8", CV_8UC1, cv::COLOR_BayerBG2BGR},
    Encoding{"bayer_bggr8", CV_8UC1, cv::COLOR_BayerRG2BGR},
    Encoding{"bayer_gbrg8", CV_8UC1, cv::COLOR_BayerGR2BGR},
    Encoding{"bayer_grbg8", CV_8UC1, cv::COLOR_BayerGB2BGR},
    Encoding{"bayer_rggb16", CV_16UC1, cv::COLOR_BayerBG2BGR},
    Encoding{"bayer_bggr16", CV_16UC1, cv::COLOR_BayerRG2BGR},
    Encoding{"bayer_gbrg16", CV_16UC1, cv::COLOR_BayerGR2BGR},
    Encoding{"bayer_grbg16", CV_16UC1, cv::COLOR_BayerGB2BGR},
};

const Encoding& encoding_of(const messages::Image& message, const std::string& name) {
  const auto found = std::find_if(
      kEncodings.begin(), kEncodings.end(),
      [&message](const Encoding& encoding) { return encoding.name == message.encoding; });
  if (found != kEncodings.end()) return *found;
  std::string known;
  for (const Encoding& encoding : kEncodings)
    known.append(known.empty() ? "" : ", ").append(encoding.name);
  throw InputError(
      fmt::format("{}: has the encoding '{}', expected one of {}", name, message.encoding, known));
}

// The pixels as they are stored, in this computer's byte order, as a picture of its own.
cv::Mat pixels_of(const messages::Image& message, int type, const std::string& name) {
  require_reasonable_size(name, message.width, message.height);
  const std::size_t row = std::size_t{message.width} * static_cast<std::size_t>(CV_ELEM_SIZE(type));
  if (message.step < row || message.data.size() < std::size_t{message.step} * message.height) {
    throw InputError(fmt::format(
        "{}: has {} bytes in rows of {}, expected {} rows of at least {} for {} x {} pixels of {}",
        name, message.data.size(), message.step, message.height, row, message.width, message.height,
        message.encoding));
  }
  cv::Mat pixels(static_cast<int>(message.height), static_cast<int>(message.width), type);
  for (int y = 0; y < pixels.rows; ++y)
    std::memcpy(pixels.ptr(y),
                message.data.data() + std::size_t{message.step} * static_cast<std::size_t>(y), row);
  const auto size = static_cast<std::size_t>(CV_ELEM_SIZE1(type));
  const bool is_swapped = (message.is_bigendian != 0) != (std::endian::native == std::endian::big);
  if (is_swapped && size > 1) {
    for (int y = 0; y < pixels.rows; ++y) {
      for (std::size_t i = 0; i < row; i += size)
        std::reverse(pixels.ptr(y) + i, pixels.ptr(y) + i + size);
    }
  }
  return pixels;
}

std::string_view bytes_of(const messages::CompressedImage& message) {
  return {reinterpret_cast<const char*>(message.data.data()), message.data.size()};
}

// What compressed_depth_image_transport writes before the picture: what it is, and the two numbers
// of its quantization.
struct DepthHeader {
  std::int32_t format = 0;
  float scale = 0.0F;
  float offset = 0.0F;
};

// Inverse depth was stored as `scale / depth + offset`.
cv::Mat metres_from_quantized(const cv::Mat& stored, const DepthHeader& header) {
  cv::Mat depth_m(stored.size(), CV_32FC1);
  for (int y = 0; y < stored.rows; ++y) {
    const auto* in = stored.ptr<std::uint16_t>(y);
    auto* out = depth_m.ptr<float>(y);
    for (int x = 0; x < stored.cols; ++x)
      out[x] = in[x] == 0 ? 0.0F : header.scale / (static_cast<float>(in[x]) - header.offset);
  }
  return metres_from_floats(depth_m);
}

// Of a side; one that no picture has stays one that no picture has.
int whole_pixels(double count) {
  return static_cast<int>(std::min(count, double{std::numeric_limits<int>::max()}));
}

// Numbers of a calibration for the part of the picture that was taken.
template <class Camera>
void crop_and_bin(const messages::CameraInfo& info, Camera& camera) {
  const auto bin_x = static_cast<double>(std::max(info.binning_x, 1U));
  const auto bin_y = static_cast<double>(std::max(info.binning_y, 1U));
  const bool is_cropped = info.roi.width > 0 && info.roi.height > 0;
  const double width = is_cropped ? info.roi.width : info.width;
  const double height = is_cropped ? info.roi.height : info.height;
  camera.width_px = whole_pixels(width / bin_x);
  camera.height_px = whole_pixels(height / bin_y);
  // pixels have their centres at whole numbers: of a block of n, at (n - 1) / 2
  camera.fx_px /= bin_x;
  camera.fy_px /= bin_y;
  camera.cx_px = (camera.cx_px - info.roi.x_offset - (bin_x - 1.0) / 2.0) / bin_x;
  camera.cy_px = (camera.cy_px - info.roi.y_offset - (bin_y - 1.0) / 2.0) / bin_y;
}

core::Camera pinhole_of(const messages::CameraInfo& info, const std::vector<double>& d) {
  core::PinholeRadtan camera{
      .fx_px = info.k[0], .fy_px = info.k[4], .cx_px = info.k[2], .cy_px = info.k[5]};
  double* const places[] = {&camera.k1, &camera.k2, &camera.p1, &camera.p2,
                            &camera.k3, &camera.k4, &camera.k5, &camera.k6};
  for (std::size_t i = 0; i < std::min(d.size(), std::size(places)); ++i) *places[i] = d[i];
  crop_and_bin(info, camera);
  return camera;
}

core::Camera fisheye_of(const messages::CameraInfo& info) {
  core::KannalaBrandt camera{
      .fx_px = info.k[0], .fy_px = info.k[4], .cx_px = info.k[2], .cy_px = info.k[5]};
  double* const places[] = {&camera.k1, &camera.k2, &camera.k3, &camera.k4};
  for (std::size_t i = 0; i < std::min(info.d.size(), std::size(places)); ++i)
    *places[i] = info.d[i];
  crop_and_bin(info, camera);
  return camera;
}

core::Camera rectified_of(const messages::CameraInfo& info) {
  core::PinholeRadtan camera{
      .fx_px = info.p[0], .fy_px = info.p[5], .cx_px = info.p[2], .cy_px = info.p[6]};
  crop_and_bin(info, camera);
  return camera;
}

bool is_without_distortion(const messages::CameraInfo& info) {
  return std::all_of(info.d.begin(), info.d.end(), [](double value) { return value == 0.0; });
}

struct DistortionModel {
  std::string name;
  std::vector<double> d;
};

DistortionModel distortion_of(const core::PinholeRadtan& camera) {
  if (camera.k4 != 0.0 || camera.k5 != 0.0 || camera.k6 != 0.0)
    return {
        "rational_polynomial",
        {camera.k1, camera.k2, camera.p1, camera.p2, camera.k3, camera.k4, camera.k5, camera.k6}};
  return {"plumb_bob", {camera.k1, camera.k2, camera.p1, camera.p2, camera.k3}};
}

DistortionModel distortion_of(const core::KannalaBrandt& camera) {
  return {"equidistant", {camera.k1, camera.k2, camera.k3, camera.k4}};
}

}  // namespace

cv::Mat image_of(const messages::Image& message, const std::string& name) {
  const Encoding& encoding = encoding_of(message, name);
  cv::Mat image = pixels_of(message, encoding.type, name);
  if (CV_MAT_DEPTH(encoding.type) == CV_16U) {
    constexpr double k8Of16Bits = 1.0 / 257.0;
    image.convertTo(image, CV_8U, k8Of16Bits);
  }
  if (encoding.conversion < 0) return image;
  const bool has_pairs = encoding.type == CV_8UC2 || encoding.name.starts_with("bayer");
  if (has_pairs && (image.cols < 2 || image.rows < 2 || image.cols % 2 != 0))
    throw InputError(fmt::format("{}: is {} x {} pixels, expected an even width for {}", name,
                                 image.cols, image.rows, encoding.name));
  cv::Mat converted;
  cv::cvtColor(image, converted, encoding.conversion);
  return converted;
}

cv::Mat image_of(const messages::CompressedImage& message, const std::string& name) {
  return decode_image(bytes_of(message), name);
}

bool is_depth_encoding(const std::string& encoding) {
  return encoding == "16UC1" || encoding == "32FC1";
}

bool is_depth_format(const std::string& format) {
  return format.find("compressedDepth") != std::string::npos;
}

cv::Mat depth_of(const messages::Image& message, const std::string& name, double units_per_m) {
  if (message.encoding == "32FC1") return metres_from_floats(pixels_of(message, CV_32FC1, name));
  if (message.encoding == "16UC1" || message.encoding == "mono16")
    return metres_from_units(pixels_of(message, CV_16UC1, name), units_per_m);
  throw InputError(fmt::format("{}: has the encoding '{}', expected depth as 16UC1 or 32FC1", name,
                               message.encoding));
}

cv::Mat depth_of(const messages::CompressedImage& message, const std::string& name,
                 double units_per_m) {
  std::string_view bytes = bytes_of(message);
  DepthHeader header;
  if (!is_picture(bytes) && bytes.size() > sizeof(header)) {
    std::memcpy(&header, bytes.data(), sizeof(header));
    bytes.remove_prefix(sizeof(header));
  }
  if (message.format.find("32FC1") == std::string::npos || header.scale == 0.0F)
    return decode_depth(bytes, name, units_per_m);
  // read as it is stored: a unit of a metre leaves the numbers
  cv::Mat stored;
  decode_depth(bytes, name, 1.0).convertTo(stored, CV_16UC1);
  return metres_from_quantized(stored, header);
}

std::optional<core::Camera> camera_of(const messages::CameraInfo& info, bool is_rectified,
                                      const std::string& name) {
  if (is_rectified ? info.p[0] == 0.0 : info.k[0] == 0.0) return std::nullopt;
  core::Camera camera;
  if (is_rectified) {
    camera = rectified_of(info);
  } else if (info.distortion_model == "equidistant" || info.distortion_model == "fisheye") {
    camera = fisheye_of(info);
  } else if (info.distortion_model == "plumb_bob" ||
             info.distortion_model == "rational_polynomial") {
    camera = pinhole_of(info, info.d);
  } else if (is_without_distortion(info)) {
    camera = pinhole_of(info, {});
  } else {
    throw InputError(fmt::format(
        "{}: has the distortion model '{}', expected plumb_bob, rational_polynomial or equidistant",
        name, info.distortion_model));
  }
  if (const auto fault = geometry::fault_of(camera))
    throw InputError(fmt::format("{}: is no calibration: {}", name, *fault));
  return camera;
}

messages::CameraInfo camera_info_of(const core::Camera& camera) {
  return std::visit(
      [](const auto& model) {
        auto [name, d] = distortion_of(model);
        messages::CameraInfo info;
        info.width = static_cast<std::uint32_t>(model.width_px);
        info.height = static_cast<std::uint32_t>(model.height_px);
        info.distortion_model = std::move(name);
        info.d = std::move(d);
        info.k = {model.fx_px, 0, model.cx_px, 0, model.fy_px, model.cy_px, 0, 0, 1};
        info.r = {1, 0, 0, 0, 1, 0, 0, 0, 1};
        info.p = {model.fx_px, 0, model.cx_px, 0, 0, model.fy_px, model.cy_px, 0, 0, 0, 1, 0};
        return info;
      },
      camera);
}

}  // namespace samewhere::input
