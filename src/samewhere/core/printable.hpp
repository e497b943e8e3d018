#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace samewhere::core {

// What comes from outside (names, words of files, reasons) may hold bytes that move a terminal's
// cursor, hide text or turn its direction. In both, each such character is a '?': control
// characters (C0, DEL, C1), line and paragraph separators, directions, tags, and bytes that are not
// UTF-8. Other letters of UTF-8 stay.

// Text of many lines: line breaks and tabs stay, too.
std::string printable_text(std::string_view text);

// Text for one line, shortened in its middle to about `max_bytes`: its end often says what was
// expected.
std::string printable_line(std::string_view text, std::size_t max_bytes);

// As much as a message or a value of a table may have.
inline constexpr std::size_t kMaxMessage = 2000;

}  // namespace samewhere::core
