#include <algorithm>
#include <cstdint>
#include <iterator>

#include <fmt/format.h>

#include <samewhere/core/printable.hpp>

namespace samewhere::core {
namespace {

struct Character {
  char32_t code = 0;
  std::size_t num_bytes = 0;  // 0: these bytes are not UTF-8
};

bool is_continuation(char byte) { return (static_cast<unsigned char>(byte) & 0xc0U) == 0x80U; }

// The character that the text, which is not empty, begins with.
Character first_character(std::string_view text) {
  constexpr char32_t kSmallest[] = {0, 0, 0x80, 0x800, 0x10000};  // of so many bytes
  const auto lead = static_cast<unsigned char>(text.front());
  if (lead < 0x80) return {lead, 1};
  const std::size_t num_bytes = lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : 2;
  if (lead < 0xc2 || lead > 0xf4 || text.size() < num_bytes) return {};
  char32_t code = lead & (0x7fU >> num_bytes);
  for (std::size_t i = 1; i < num_bytes; ++i) {
    if (!is_continuation(text[i])) return {};
    code = (code << 6U) | (static_cast<unsigned char>(text[i]) & 0x3fU);
  }
  const bool is_surrogate = code >= 0xd800 && code <= 0xdfff;
  if (code < kSmallest[num_bytes] || code > 0x10ffff || is_surrogate) return {};
  return {code, num_bytes};
}

bool is_shown(char32_t code) {
  struct Range {
    char32_t first, last;
  };
  constexpr Range kHidden[] = {
      {0x00, 0x1f},       {0x7f, 0x9f},      // controls
      {0x061c, 0x061c},   {0x200b, 0x200b},  // Arabic letter mark, blank without width
      {0x200e, 0x200f},   {0x2028, 0x202e},  // directions, separators
      {0x2060, 0x206f},   {0xfeff, 0xfeff},  // joiners, isolates, byte order mark
      {0xfff9, 0xfffb},   {0xfffe, 0xffff},  // annotations, no characters
      {0xe0000, 0xe0fff},                    // tags
  };
  return std::none_of(std::begin(kHidden), std::end(kHidden), [&](const Range& range) {
    return code >= range.first && code <= range.last;
  });
}

std::string cleaned(std::string_view text, std::string_view kept) {
  std::string clean;
  clean.reserve(text.size());
  while (!text.empty()) {
    const Character character = first_character(text);
    const std::string_view bytes = text.substr(0, std::max<std::size_t>(character.num_bytes, 1));
    const bool is_kept = kept.find(bytes.front()) != std::string_view::npos ||
                         (character.num_bytes > 0 && is_shown(character.code));
    if (is_kept) {
      clean += bytes;
    } else {
      clean += '?';
    }
    text.remove_prefix(bytes.size());
  }
  return clean;
}

}  // namespace

std::string printable_text(std::string_view text) { return cleaned(text, "\n\t"); }

std::string printable_line(std::string_view text, std::size_t max_bytes) {
  if (text.size() <= max_bytes) return cleaned(text, "");
  std::size_t head = 2 * max_bytes / 3;
  std::size_t tail = text.size() - max_bytes / 3;
  while (head > 0 && is_continuation(text[head])) --head;
  while (tail < text.size() && is_continuation(text[tail])) ++tail;
  return fmt::format("{} ... ({} bytes left out) ... {}", cleaned(text.substr(0, head), ""),
                     tail - head, cleaned(text.substr(tail), ""));
}

}  // namespace samewhere::core
