#include <cstddef>
#include <cstdint>

#include <samewhere/input/exif.hpp>

namespace samewhere::input {
namespace {

// Numbers of a TIFF block, of either byte order; nothing beyond its end.
class Tiff {
 public:
  explicit Tiff(std::string_view bytes) : bytes_(bytes), is_little_(bytes.starts_with("II")) {}

  std::optional<std::uint32_t> number(std::size_t at, std::size_t size) const {
    if (at > bytes_.size() || size > bytes_.size() - at) return std::nullopt;
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < size; ++i) {
      const std::size_t from = is_little_ ? at + size - 1 - i : at + i;
      value = (value << 8U) | static_cast<unsigned char>(bytes_[from]);
    }
    return value;
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

 private:
  std::string_view bytes_;
  bool is_little_;
};

std::optional<double> focal_length_in(const Tiff& tiff) {
  constexpr std::uint32_t kExifDirectory = 0x8769;
  constexpr std::uint32_t kFocalLengthIn35mmFilm = 0xA405;
  constexpr double kMax_mm = 2000.0;
  const auto first = tiff.number(4, 4);
  const auto link = first ? tiff.entry(*first, kExifDirectory) : std::nullopt;
  const auto directory = link ? tiff.number(*link + 8, 4) : std::nullopt;
  const auto entry = directory ? tiff.entry(*directory, kFocalLengthIn35mmFilm) : std::nullopt;
  const auto length_mm = entry ? tiff.number(*entry + 8, 2) : std::nullopt;  // a SHORT
  if (!length_mm || *length_mm == 0 || *length_mm > kMax_mm) return std::nullopt;
  return *length_mm;
}

}  // namespace

std::optional<double> focal_length_35mm(std::string_view jpeg) {
  constexpr std::string_view kExif("Exif\0\0", 6);
  const std::string_view head =
      jpeg.substr(0, std::size_t{1} << 17U);  // segments are 64 KiB at most
  const std::size_t at = head.find(kExif);
  if (!head.starts_with("\xFF\xD8") || at == std::string_view::npos) return std::nullopt;
  return focal_length_in(Tiff(head.substr(at + kExif.size())));
}

}  // namespace samewhere::input
