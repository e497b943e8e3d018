#include <bit>
#include <cmath>
#include <csetjmp>
#include <cstdint>
#include <cstring>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>
#include <png.h>
#include <turbojpeg.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/input/image_file.hpp>
#include <samewhere/input/other_pictures.hpp>
#include <samewhere/input/picture_size.hpp>

namespace samewhere::input {
namespace {

using core::InputError;
using std::filesystem::path;

bool is_jpeg(std::string_view bytes) { return bytes.starts_with("\xff\xd8\xff"); }
bool is_png(std::string_view bytes) { return bytes.starts_with("\x89PNG\r\n\x1a\n"); }

// ---- JPEG

[[noreturn]] void fail_jpeg(const path& file, tjhandle decoder) {
  throw InputError(
      fmt::format("{}: damaged JPEG file: {}", file.string(), tjGetErrorStr2(decoder)));
}

// Bytes that stand between two markers are skipped without loss (some web cameras write them);
// every other warning means that pixels were made up.
bool is_harmless(tjhandle decoder) {
  return tjGetErrorCode(decoder) == TJERR_WARNING &&
         std::string_view(tjGetErrorStr2(decoder)).find("extraneous bytes before marker") !=
             std::string_view::npos;
}

// Cyan, magenta, yellow and black, each stored as 255 less the ink, as all programs write them.
cv::Mat bgr_from_inks(const cv::Mat& inks) {
  cv::Mat image(inks.size(), CV_8UC3);
  for (int y = 0; y < inks.rows; ++y) {
    for (int x = 0; x < inks.cols; ++x) {
      const auto& paper = inks.at<cv::Vec4b>(y, x);
      const auto shaded = [&paper](int ink) {
        return static_cast<std::uint8_t>((paper[ink] * paper[3] + 127) / 255);
      };
      image.at<cv::Vec3b>(y, x) = {shaded(2), shaded(1), shaded(0)};
    }
  }
  return image;
}

cv::Mat decode_jpeg(const path& file, std::string_view bytes) {
  const std::unique_ptr<void, int (*)(tjhandle)> decoder(tjInitDecompress(), &tjDestroy);
  core::require(decoder != nullptr, "libjpeg-turbo gives a decoder");
  const auto* data = reinterpret_cast<const unsigned char*>(bytes.data());
  int width_px = 0;  // stays 0 if the file ends before the picture: to the library no error
  int height_px = 0;
  int subsampling = 0;
  int colour_space = 0;
  if (tjDecompressHeader3(decoder.get(), data, bytes.size(), &width_px, &height_px, &subsampling,
                          &colour_space) != 0 &&
      !is_harmless(decoder.get())) {
    fail_jpeg(file, decoder.get());
  }
  require_reasonable_size(file, width_px, height_px);
  const bool is_grey = colour_space == TJCS_GRAY;
  const bool is_print = colour_space == TJCS_CMYK || colour_space == TJCS_YCCK;
  cv::Mat image(height_px, width_px, is_grey ? CV_8UC1 : is_print ? CV_8UC4 : CV_8UC3);
  const int format = is_grey ? TJPF_GRAY : is_print ? TJPF_CMYK : TJPF_BGR;
  if (tjDecompress2(decoder.get(), data, bytes.size(), image.data, width_px,
                    static_cast<int>(image.step), height_px, format,
                    TJFLAG_ACCURATEDCT | TJFLAG_LIMITSCANS) != 0 &&
      !is_harmless(decoder.get())) {
    fail_jpeg(file, decoder.get());
  }
  return is_print ? bgr_from_inks(image) : image;
}

// ---- PNG

// One pass through a PNG file. libpng reports errors by longjmp; no frame that it leaves may own
// anything, so every call of the library goes through guarded(), in a lambda that only borrows.
class PngReader {
 public:
  PngReader(const path& file, std::string_view bytes)
      : file_(file),
        rest_(bytes),
        png_(png_create_read_struct(PNG_LIBPNG_VER_STRING, this, &PngReader::fail,
                                    &PngReader::ignore_warning)) {
    core::require(png_ != nullptr, "libpng gives a decoder");
    info_ = png_create_info_struct(png_);
    png_set_read_fn(png_, this, &PngReader::read);
    png_set_chunk_cache_max(png_, kMaxTextChunks);
  }
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;
  ~PngReader() { png_destroy_read_struct(&png_, &info_, nullptr); }

  void read_header() {
    guarded([this] { png_read_info(png_, info_); });
    require_reasonable_size(file_, png_get_image_width(png_, info_),
                            png_get_image_height(png_, info_));
  }

  bool is_grey() const {
    return (png_get_color_type(png_, info_) & (PNG_COLOR_MASK_COLOR | PNG_COLOR_MASK_PALETTE)) == 0;
  }
  bool has_alpha() const { return (png_get_color_type(png_, info_) & PNG_COLOR_MASK_ALPHA) != 0; }
  int bits_per_channel() const { return png_get_bit_depth(png_, info_); }

  cv::Mat read_bgr_or_grey() {
    guarded([this] {
      png_set_palette_to_rgb(png_);
      png_set_expand_gray_1_2_4_to_8(png_);
      png_set_scale_16(png_);
      png_set_strip_alpha(png_);
      png_set_bgr(png_);
    });
    return read_rows(is_grey() ? CV_8UC1 : CV_8UC3);
  }

  cv::Mat read_16_bit_grey() {
    if constexpr (std::endian::native == std::endian::little) {
      guarded([this] { png_set_swap(png_); });
    }
    return read_rows(CV_16UC1);
  }

 private:
  cv::Mat read_rows(int type) {
    guarded([this] {
      png_set_interlace_handling(png_);
      png_read_update_info(png_, info_);
    });
    cv::Mat image(static_cast<int>(png_get_image_height(png_, info_)),
                  static_cast<int>(png_get_image_width(png_, info_)), type);
    core::require(png_get_rowbytes(png_, info_) == image.step, "a PNG row fills an image row");
    std::vector<png_bytep> rows;
    for (int y = 0; y < image.rows; ++y) rows.push_back(image.ptr(y));
    guarded([this, &rows] {
      png_read_image(png_, rows.data());
      png_read_end(png_, nullptr);
    });
    return image;
  }

  template <class Step>
  void guarded(const Step& step) {
    if (setjmp(png_jmpbuf(png_)) != 0) {
      throw InputError(fmt::format("{}: damaged PNG file: {}", file_.string(), message_));
    }
    step();
  }

  [[noreturn]] static void fail(png_structp png, png_const_charp message) {
    static_cast<PngReader*>(png_get_error_ptr(png))->message_ = message;
    png_longjmp(png, 1);
  }

  static void ignore_warning(png_structp /*png*/, png_const_charp /*message*/) {}

  static void read(png_structp png, png_bytep out, std::size_t num_bytes) {
    auto* self = static_cast<PngReader*>(png_get_io_ptr(png));
    if (self->rest_.size() < num_bytes) png_error(png, "it ends early");
    std::memcpy(out, self->rest_.data(), num_bytes);
    self->rest_.remove_prefix(num_bytes);
  }

  // each may unpack to 8 MB, which libpng limits; cameras write a few
  static constexpr png_uint_32 kMaxTextChunks = 16;

  const path& file_;
  std::string_view rest_;
  std::string message_;
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
};

cv::Mat decode_png(const path& file, std::string_view bytes) {
  PngReader reader(file, bytes);
  reader.read_header();
  return reader.read_bgr_or_grey();
}

cv::Mat decode_depth_png(const path& file, std::string_view bytes) {
  PngReader reader(file, bytes);
  reader.read_header();
  if (!reader.is_grey() || reader.has_alpha() || reader.bits_per_channel() != 16) {
    throw InputError(fmt::format("{}: has {} bits per channel{}, expected depth as 16-bit grey",
                                 file.string(), reader.bits_per_channel(),
                                 reader.is_grey() ? "" : " and colour"));
  }
  return reader.read_16_bit_grey();
}

// ---- other formats

// Grey or blue, green, red, of 8 bits each; 16 are scaled.
cv::Mat as_picture(const path& file, const cv::Mat& stored) {
  constexpr double k8From16Bits = 1.0 / 257.0;
  if (stored.depth() != CV_8U && stored.depth() != CV_16U) {
    throw InputError(file.string() +
                     ": holds floating-point values, expected a picture of 8 or 16 bits a channel");
  }
  cv::Mat image = stored;
  if (stored.depth() == CV_16U) stored.convertTo(image, CV_8U, k8From16Bits);
  if (image.channels() == 2) cv::extractChannel(image, image, 0);
  if (image.channels() == 4) cv::cvtColor(image, image, cv::COLOR_BGRA2BGR);
  return image;
}

cv::Mat decode_depth_other(const path& file, std::string_view bytes) {
  cv::Mat stored = decode_other_picture(file, bytes);
  if (stored.type() == CV_16UC1 || stored.type() == CV_32FC1) return stored;
  throw InputError(
      fmt::format("{}: has {} bits per channel and {} channels, expected depth as "
                  "16-bit grey, or metres as 32-bit floats",
                  file.string(), 8 * stored.elemSize1(), stored.channels()));
}

}  // namespace

cv::Mat metres_from_units(const cv::Mat& stored, double units_per_m) {
  cv::Mat depth_m(stored.size(), CV_32FC1);
  for (int y = 0; y < stored.rows; ++y) {
    const auto* in = stored.ptr<std::uint16_t>(y);
    auto* out = depth_m.ptr<float>(y);
    for (int x = 0; x < stored.cols; ++x) {
      // 65535 is what sensors write that have no measurement, and saturation is none either
      out[x] = in[x] == 0xffff ? 0.0F : static_cast<float>(in[x] / units_per_m);
    }
  }
  return depth_m;
}

// What is no distance is unknown: NaN, infinite, negative.
cv::Mat metres_from_floats(cv::Mat depth_m) {
  for (int y = 0; y < depth_m.rows; ++y) {
    for (int x = 0; x < depth_m.cols; ++x) {
      float& value_m = depth_m.at<float>(y, x);
      if (!std::isfinite(value_m) || value_m <= 0.0F) value_m = 0.0F;  // -0, too
    }
  }
  return depth_m;
}

bool is_picture(std::string_view bytes) {
  return is_jpeg(bytes) || is_png(bytes) || is_other_picture(bytes);
}

cv::Mat decode_image(std::string_view bytes, const path& name) {
  if (is_jpeg(bytes)) return decode_jpeg(name, bytes);
  if (is_png(bytes)) return decode_png(name, bytes);
  if (is_other_picture(bytes)) return as_picture(name, decode_other_picture(name, bytes));
  throw InputError(
      name.string() +
      (bytes.empty() ? ": is empty, expected an image, JPEG, PNG, BMP, PNM, TIFF or WebP"
                     : ": is neither JPEG nor PNG, BMP, PNM, TIFF or WebP, the image formats that "
                       "are read"));
}

cv::Mat decode_depth(std::string_view bytes, const path& name, double units_per_m) {
  core::require(units_per_m > 0.0, "depth units per metre are positive");
  if (!is_png(bytes) && !is_other_picture(bytes))
    throw InputError(name.string() + ": is not PNG, PGM or TIFF, expected a depth image");
  cv::Mat stored = is_png(bytes) ? decode_depth_png(name, bytes) : decode_depth_other(name, bytes);
  if (stored.type() == CV_32FC1) return metres_from_floats(std::move(stored));
  return metres_from_units(stored, units_per_m);
}

cv::Mat read_image(const path& path) {
  return decode_image(core::read_file(path, core::kPictureLimit), path);
}

cv::Mat read_depth(const path& path, double units_per_m) {
  return decode_depth(core::read_file(path, core::kPictureLimit), path, units_per_m);
}

}  // namespace samewhere::input
