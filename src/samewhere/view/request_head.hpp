#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace samewhere::view {

inline constexpr std::size_t kMaxHead_bytes = 16'384;
inline constexpr std::size_t kMaxBody_bytes = 65'536;

// The head of an HTTP request with those headers alone that the viewer reads. What the HTTP library
// would do for others (ranges, compression, forms, chunked bodies) costs memory or time that a
// client chooses.
struct RequestHead {
  std::string text;  // request line and headers, with the empty line
  int status = 0;    // not 0: refused with this status of HTTP
};

// `head` ends with its empty line. Refused: no HTTP/1, control characters, a header that counts
// and stands there twice, a body of unknown length or more than kMaxBody_bytes.
RequestHead checked_head(std::string_view head);

}  // namespace samewhere::view
