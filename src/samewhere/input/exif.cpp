#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include <samewhere/input/exif.hpp>

namespace samewhere::input {
namespace {

using namespace std::string_view_literals;

// An unsigned number of 1 to 4 bytes; nothing beyond the end.
std::optional<std::uint32_t> number_at(std::string_view bytes, std::size_t at, std::size_t size,
                                       bool is_little) {
  if (at > bytes.size() || size > bytes.size() - at) return std::nullopt;
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < size; ++i) {
    const std::size_t from = is_little ? at + size - 1 - i : at + i;
    value = (value << 8U) | static_cast<unsigned char>(bytes[from]);
  }
  return value;
}

// Numbers of the TIFF structure that EXIF is, of either byte order.
class Tiff {
 public:
  explicit Tiff(std::string_view bytes) : bytes_(bytes), is_little_(bytes.starts_with("II")) {}

  std::optional<std::uint32_t> number(std::size_t at, std::size_t size) const {
    return number_at(bytes_, at, size, is_little_);
  }

  // Where the entry of a tag lies in the directory at `directory`: 12 bytes tag, type, count,
  // value.
  std::optional<std::size_t> entry(std::size_t directory, std::uint32_t tag) const {
    const auto count = number(directory, 2);
    for (std::size_t i = 0; count && i < *count; ++i) {
      const std::size_t at = directory + 2 + 12 * i;
      const auto found = number(at, 2);
      if (!found) return std::nullopt;
      if (*found == tag) return at;
    }
    return std::nullopt;
  }

  // The value of a tag as a SHORT.
  std::optional<std::uint32_t> short_of(std::optional<std::uint32_t> directory,
                                        std::uint32_t tag) const {
    const auto at = directory ? entry(*directory, tag) : std::nullopt;
    return at ? number(*at + 8, 2) : std::nullopt;
  }

  std::optional<std::uint32_t> first_directory() const { return number(4, 4); }

 private:
  std::string_view bytes_;
  bool is_little_;
};

// The EXIF segment before the picture itself.
std::optional<Tiff> exif_of(std::string_view jpeg) {
  constexpr std::uint32_t kStartOfScan = 0xffda;
  constexpr std::uint32_t kApp1 = 0xffe1;
  constexpr std::string_view kExif = "Exif\0\0"sv;
  if (!jpeg.starts_with("\xff\xd8")) return std::nullopt;
  for (std::size_t at = 2; at + 4 <= jpeg.size();) {
    const std::uint32_t marker = number_at(jpeg, at, 2, false).value_or(0);
    const std::uint32_t length = number_at(jpeg, at + 2, 2, false).value_or(0);
    if (marker >> 8U != 0xff || marker == kStartOfScan || length < 2) return std::nullopt;
    const std::string_view content = jpeg.substr(at + 4, length - 2);
    if (marker == kApp1 && content.starts_with(kExif)) return Tiff(content.substr(kExif.size()));
    at += 2 + std::size_t{length};
  }
  return std::nullopt;
}

}  // namespace

int exif_orientation(std::string_view jpeg) {
  constexpr std::uint32_t kOrientation = 0x0112;
  const std::optional<Tiff> tiff = exif_of(jpeg);
  const auto value = tiff ? tiff->short_of(tiff->first_directory(), kOrientation) : std::nullopt;
  return value && *value >= 1 && *value <= 8 ? static_cast<int>(*value) : 1;
}

std::optional<double> focal_length_35mm(std::string_view jpeg) {
  constexpr std::uint32_t kExifDirectory = 0x8769;
  constexpr std::uint32_t kFocalLengthIn35mmFilm = 0xA405;
  constexpr double kMax_mm = 2000.0;
  const std::optional<Tiff> tiff = exif_of(jpeg);
  const auto first = tiff ? tiff->first_directory() : std::nullopt;
  const auto link = first ? tiff->entry(*first, kExifDirectory) : std::nullopt;
  const auto directory = link ? tiff->number(*link + 8, 4) : std::nullopt;
  const auto length_mm = tiff ? tiff->short_of(directory, kFocalLengthIn35mmFilm) : std::nullopt;
  if (!length_mm || *length_mm == 0 || *length_mm > kMax_mm) return std::nullopt;
  return *length_mm;
}

}  // namespace samewhere::input
