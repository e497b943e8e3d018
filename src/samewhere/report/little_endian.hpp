#pragma once

#include <bit>
#include <string>
#include <type_traits>

namespace samewhere::report {

static_assert(std::endian::native == std::endian::little, "bytes are written as memory has them");

// Appends the bytes of one number, the least significant first, for files of other programs.
template <class T>
void append_little_endian(std::string& bytes, T value) {
  static_assert(std::is_arithmetic_v<T>);
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

}  // namespace samewhere::report
