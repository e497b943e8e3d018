#include <cstddef>
#include <cstdint>

#include <samewhere/input/exif_orientation.hpp>

namespace samewhere::input {
namespace {

using namespace std::string_view_literals;

// 0 behind the end.
std::uint32_t number(std::string_view bytes, std::size_t at, std::size_t num_bytes, bool is_big) {
  if (at > bytes.size() || num_bytes > bytes.size() - at) return 0;
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < num_bytes; ++i) {
    const std::size_t from = is_big ? at + i : at + num_bytes - 1 - i;
    value = value << 8U | static_cast<unsigned char>(bytes[from]);
  }
  return value;
}

// The first directory of the TIFF structure that EXIF is.
int orientation_in_tiff(std::string_view tiff) {
  constexpr std::uint32_t kOrientation = 0x0112;
  const bool is_big = tiff.starts_with("MM");
  const std::size_t directory = number(tiff, 4, 4, is_big);
  const std::uint32_t num_entries = number(tiff, directory, 2, is_big);
  for (std::uint32_t i = 0; i < num_entries; ++i) {
    const std::size_t entry = directory + 2 + 12 * std::size_t{i};
    if (number(tiff, entry, 2, is_big) != kOrientation) continue;
    const auto value = static_cast<int>(number(tiff, entry + 8, 2, is_big));
    return value >= 1 && value <= 8 ? value : 1;
  }
  return 1;
}

}  // namespace

int exif_orientation(std::string_view bytes) {
  constexpr std::uint32_t kStartOfScan = 0xffda;
  constexpr std::uint32_t kApp1 = 0xffe1;
  constexpr std::string_view kExif = "Exif\0\0"sv;
  if (!bytes.starts_with("\xff\xd8")) return 1;
  for (std::size_t at = 2; at + 4 <= bytes.size();) {
    const std::uint32_t marker = number(bytes, at, 2, true);
    const std::uint32_t length = number(bytes, at + 2, 2, true);
    if (marker >> 8U != 0xff || marker == kStartOfScan || length < 2) return 1;
    const std::string_view content = bytes.substr(at + 4, length - 2);
    if (marker == kApp1 && content.starts_with(kExif))
      return orientation_in_tiff(content.substr(kExif.size()));
    at += 2 + length;
  }
  return 1;
}

}  // namespace samewhere::input
