#include <bit>
#include <cmath>
#include <csetjmp>
#include <vector>

#include <png.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/twin/render/picture_file.hpp>

namespace samewhere::twin {
namespace {

constexpr float kUnits_per_m = 5000.0F;
constexpr float kUnknown_units = 65535.0F;  // what many readers take for "no measurement"

bool is_storable(const cv::Mat& picture) {
  const int type = picture.type();
  return !picture.empty() && (type == CV_8UC1 || type == CV_8UC3 || type == CV_16UC1);
}

// One pass that writes a PNG file into a string. libpng reports errors by longjmp; no frame that it
// leaves may own anything, so its calls stand in a lambda that only borrows.
class PngWriter {
 public:
  PngWriter() : png_(png_create_write_struct(PNG_LIBPNG_VER_STRING, this, &fail, &ignore)) {
    core::require(png_ != nullptr, "libpng gives an encoder");
    info_ = png_create_info_struct(png_);
    png_set_write_fn(png_, this, &append, &flush);
  }
  PngWriter(const PngWriter&) = delete;
  PngWriter& operator=(const PngWriter&) = delete;
  ~PngWriter() { png_destroy_write_struct(&png_, &info_); }

  std::string write(const cv::Mat& picture) {
    std::vector<png_const_bytep> rows;
    for (int y = 0; y < picture.rows; ++y) rows.push_back(picture.ptr(y));
    guarded([&] {
      write_header(picture);
      for (const png_const_bytep row : rows) png_write_row(png_, row);
      png_write_end(png_, nullptr);
    });
    return std::move(bytes_);
  }

 private:
  void write_header(const cv::Mat& picture) {
    png_set_compression_level(png_, 1);
    png_set_filter(png_, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB);
    png_set_IHDR(png_, info_, static_cast<png_uint_32>(picture.cols),
                 static_cast<png_uint_32>(picture.rows), picture.depth() == CV_16U ? 16 : 8,
                 picture.channels() == 3 ? PNG_COLOR_TYPE_RGB : PNG_COLOR_TYPE_GRAY,
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_write_info(png_, info_);
    if (picture.channels() == 3) png_set_bgr(png_);
    if (picture.depth() == CV_16U && std::endian::native == std::endian::little) png_set_swap(png_);
  }

  template <class Step>
  void guarded(const Step& step) {
    if (setjmp(png_jmpbuf(png_)) != 0) core::require(false, "a picture can be written as PNG");
    step();
  }

  [[noreturn]] static void fail(png_structp png, png_const_charp /*message*/) {
    png_longjmp(png, 1);
  }
  static void ignore(png_structp /*png*/, png_const_charp /*message*/) {}
  static void append(png_structp png, png_bytep data, std::size_t num_bytes) {
    auto* self = static_cast<PngWriter*>(png_get_io_ptr(png));
    self->bytes_.append(reinterpret_cast<const char*>(data), num_bytes);
  }
  static void flush(png_structp /*png*/) {}

  std::string bytes_;
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
};

}  // namespace

std::string png_bytes(const cv::Mat& picture) {
  core::require(is_storable(picture), "a picture is 8-bit grey, 8-bit BGR or 16-bit grey");
  return PngWriter().write(picture);
}

std::optional<cv::Mat> picture_of_png(std::string_view bytes) {
  constexpr png_uint_32 kMaxSide_px = 1 << 14;  // a damaged header can claim any size
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  cv::Mat picture;
  if (png_image_begin_read_from_memory(&png, bytes.data(), bytes.size()) != 0 &&
      png.width <= kMaxSide_px && png.height <= kMaxSide_px) {
    // files without a note on gamma: 8 bits are taken for sRGB, 16 for linear, both stay as stored
    const bool is_16_bit = (png.format & PNG_FORMAT_FLAG_LINEAR) != 0;
    const bool is_colour = (png.format & PNG_FORMAT_FLAG_COLOR) != 0;
    png.format = is_16_bit ? PNG_FORMAT_LINEAR_Y : is_colour ? PNG_FORMAT_BGR : PNG_FORMAT_GRAY;
    picture.create(static_cast<int>(png.height), static_cast<int>(png.width),
                   is_16_bit   ? CV_16UC1
                   : is_colour ? CV_8UC3
                               : CV_8UC1);
    if (png_image_finish_read(&png, nullptr, picture.data, 0, nullptr) == 0) picture.release();
  }
  png_image_free(&png);
  if (picture.empty()) return std::nullopt;
  return picture;
}

cv::Mat depth_units(const cv::Mat& depth_m) {
  core::require(depth_m.type() == CV_32FC1, "depth is 32-bit float metres");
  cv::Mat units(depth_m.size(), CV_16UC1);
  for (int y = 0; y < units.rows; ++y) {
    for (int x = 0; x < units.cols; ++x) {
      const float value = std::round(depth_m.at<float>(y, x) * kUnits_per_m);
      const bool is_known = value > 0.0F && value < kUnknown_units;  // false for NaN too
      units.at<std::uint16_t>(y, x) = is_known ? static_cast<std::uint16_t>(value) : 0;
    }
  }
  return units;
}

cv::Mat depth_of_units(const cv::Mat& units) {
  core::require(units.type() == CV_16UC1, "depth in units has 16 bits");
  cv::Mat depth_m(units.size(), CV_32FC1);
  for (int y = 0; y < units.rows; ++y) {
    for (int x = 0; x < units.cols; ++x) {
      depth_m.at<float>(y, x) = static_cast<float>(units.at<std::uint16_t>(y, x)) / kUnits_per_m;
    }
  }
  return depth_m;
}

}  // namespace samewhere::twin
