#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include <samewhere/core/errors.hpp>

namespace samewhere::bags {

// Takes little-endian numbers and texts off a range of bytes. Throws InputError, without the name
// of the file, where the bytes end too early.
class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : rest_(bytes) {}

  template <class T>
  T number() {
    T value;
    std::memcpy(&value, bytes(sizeof(T)).data(), sizeof(T));
    return value;
  }
  std::string_view bytes(std::uint64_t count) {
    if (count > rest_.size())
      throw core::InputError(fmt::format("{} bytes are left, expected {}", rest_.size(), count));
    const std::string_view taken = rest_.substr(0, static_cast<std::size_t>(count));
    rest_.remove_prefix(taken.size());
    return taken;
  }
  // With its length, of four bytes, before it.
  std::string_view text() { return bytes(number<std::uint32_t>()); }
  std::string_view rest() const { return rest_; }
  bool is_empty() const { return rest_.empty(); }

 private:
  std::string_view rest_;
};

class ByteWriter {
 public:
  template <class T>
  ByteWriter& number(T value) {
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof(T));
    return *this;
  }
  ByteWriter& bytes(std::string_view value) {
    bytes_.append(value);
    return *this;
  }
  ByteWriter& text(std::string_view value) {
    return number(static_cast<std::uint32_t>(value.size())).bytes(value);
  }
  std::size_t size() const { return bytes_.size(); }
  std::string_view view() const { return bytes_; }
  std::string take() {
    std::string taken = std::move(bytes_);
    bytes_.clear();
    return taken;
  }

 private:
  std::string bytes_;
};

}  // namespace samewhere::bags
