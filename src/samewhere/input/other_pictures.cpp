#include <algorithm>
#include <cstdint>
#include <cstdlib>

#include <samewhere/core/errors.hpp>
#include <samewhere/input/other_pictures.hpp>
#include <samewhere/input/picture_size.hpp>
#include <samewhere/input/video_plugin.hpp>

namespace samewhere::input {
namespace {

using namespace std::string_view_literals;

struct Size {
  std::int64_t width_px = 0;
  std::int64_t height_px = 0;
};

// Whole numbers at places of a header; 0 behind its end.
class Header {
 public:
  Header(std::string_view bytes, bool is_big_endian)
      : bytes_(bytes), is_big_endian_(is_big_endian) {}

  std::uint32_t number(std::size_t at, std::size_t num_bytes) const {
    if (at > bytes_.size() || num_bytes > bytes_.size() - at) return 0;
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < num_bytes; ++i) {
      const std::size_t from = is_big_endian_ ? at + i : at + num_bytes - 1 - i;
      value = value << 8U | static_cast<unsigned char>(bytes_[from]);
    }
    return value;
  }

 private:
  std::string_view bytes_;
  bool is_big_endian_;
};

bool is_bmp(std::string_view bytes) { return bytes.starts_with("BM"); }
bool is_webp(std::string_view bytes) {
  return bytes.starts_with("RIFF") && bytes.size() >= 16 && bytes.substr(8, 4) == "WEBP";
}
bool is_tiff(std::string_view bytes) {
  return bytes.starts_with("II*\0"sv) || bytes.starts_with("MM\0*"sv);
}
bool is_white_space(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }
bool is_pnm(std::string_view bytes) {
  return bytes.size() > 3 && bytes[0] == 'P' && bytes[1] >= '1' && bytes[1] <= '6' &&
         (is_white_space(bytes[2]) || bytes[2] == '#');
}

Size size_of_bmp(std::string_view bytes) {
  const Header header(bytes, false);
  constexpr std::uint32_t kOldHeader = 12;
  if (header.number(14, 4) == kOldHeader) return {header.number(18, 2), header.number(20, 2)};
  // a negative height: the rows run downwards
  return {static_cast<std::int32_t>(header.number(18, 4)),
          std::abs(static_cast<std::int64_t>(static_cast<std::int32_t>(header.number(22, 4))))};
}

// The next whole number; '#' comments run to the end of their line.
std::int64_t next_number(std::string_view& text) {
  constexpr std::int64_t kMost = 1'000'000'000;
  while (!text.empty() && (is_white_space(text.front()) || text.front() == '#')) {
    const std::size_t end = text.front() == '#' ? text.find('\n') : 1;
    text.remove_prefix(std::min(end, text.size()));
  }
  std::int64_t number = 0;
  for (; !text.empty() && text.front() >= '0' && text.front() <= '9' && number < kMost;
       text.remove_prefix(1))
    number = 10 * number + (text.front() - '0');
  return number;
}

Size size_of_pnm(std::string_view bytes) {
  bytes.remove_prefix(2);
  const std::int64_t width_px = next_number(bytes);
  return {width_px, next_number(bytes)};
}

Size size_of_webp(std::string_view bytes) {
  const Header header(bytes, false);
  constexpr std::uint32_t k14Bits = 0x3fff;
  const std::string_view kind = bytes.substr(12, 4);
  if (kind == "VP8X") return {header.number(24, 3) + 1LL, header.number(27, 3) + 1LL};
  if (kind == "VP8L") {
    const std::uint32_t bits = header.number(21, 4);
    return {(bits & k14Bits) + 1LL, (bits >> 14U & k14Bits) + 1LL};
  }
  return {header.number(26, 2) & k14Bits, header.number(28, 2) & k14Bits};
}

// The value of a tag in the first directory, or else `otherwise`.
std::uint32_t tiff_value(std::string_view bytes, std::uint32_t tag, std::uint32_t otherwise) {
  constexpr std::uint32_t kShort = 3;
  const Header header(bytes, bytes.front() == 'M');
  const std::size_t directory = header.number(4, 4);
  const std::size_t num_entries = header.number(directory, 2);
  for (std::size_t i = 0; i < num_entries; ++i) {
    const std::size_t entry = directory + 2 + 12 * i;
    if (header.number(entry, 2) == tag)
      return header.number(entry + 8, header.number(entry + 2, 2) == kShort ? 2 : 4);
  }
  return otherwise;
}

Size size_of_tiff(std::string_view bytes) {
  return {tiff_value(bytes, 256, 0), tiff_value(bytes, 257, 0)};
}

// Memory is taken for a tile as well as for the picture.
Size size_of_tile(std::string_view bytes) {
  return {tiff_value(bytes, 322, 1), tiff_value(bytes, 323, 1)};
}

Size size_by_header(std::string_view bytes) {
  if (is_bmp(bytes)) return size_of_bmp(bytes);
  if (is_pnm(bytes)) return size_of_pnm(bytes);
  if (is_webp(bytes)) return size_of_webp(bytes);
  return size_of_tiff(bytes);
}

}  // namespace

bool is_other_picture(std::string_view bytes) {
  return is_bmp(bytes) || is_pnm(bytes) || is_webp(bytes) || is_tiff(bytes);
}

cv::Mat decode_other_picture(const std::filesystem::path& file, std::string_view bytes) {
  core::require(is_other_picture(bytes), "the picture is of a format that the plugin decodes");
  const Size size = size_by_header(bytes);
  require_reasonable_size(file, size.width_px, size.height_px);
  if (is_tiff(bytes)) {
    const Size tile = size_of_tile(bytes);
    require_reasonable_size(file, tile.width_px, tile.height_px);
  }
  cv::Mat image;
  const auto* data = reinterpret_cast<const unsigned char*>(bytes.data());
  const bool is_whole = decode_by_plugin(data, bytes.size(), image);
  if (!is_whole || image.cols != size.width_px || image.rows != size.height_px) {
    throw core::InputError(file.string() +
                           ": damaged image file, or of a kind of BMP, PNM, TIFF or WebP that is "
                           "not read");
  }
  return image;
}

}  // namespace samewhere::input
