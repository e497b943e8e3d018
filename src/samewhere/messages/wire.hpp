#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace samewhere::messages {

// How a message is laid out in bytes.
//  * kCdr: XCDR version 1 of the OMG's DDS-XTypes, which ROS 2 uses: four bytes that name the byte
//    order, then the fields, each aligned to its size
//  * kRos1: ROS 1: little-endian, not aligned
enum class Layout { kCdr, kRos1 };

// Reads the fields of one message in their order. Throws core::InputError, without the name of a
// file, where the bytes end too early or a length cannot be. Every message has a function
// `fields(wire, message)` that lists its fields for the reader and the writer.
class WireReader {
 public:
  WireReader(std::string_view bytes, Layout layout);

  Layout layout() const { return layout_; }

  template <class... Fields>
  void operator()(Fields&... values) {
    (read(values), ...);
  }

 private:
  template <class T>
  void read(T& value) {
    if constexpr (std::is_same_v<T, bool>) {
      value = number<std::uint8_t>() != 0;
    } else if constexpr (std::is_arithmetic_v<T>) {
      value = number<T>();
    } else {
      fields(*this, value);
    }
  }
  void read(std::string& text);
  template <class T>
  void read(std::vector<T>& values) {
    const std::uint32_t count = read_count();
    if constexpr (std::is_arithmetic_v<T>) {
      if (count == 0) return values.clear();
      align(sizeof(T));
      require_rest(count, sizeof(T));
      values.resize(count);
      for (T& value : values) value = number<T>();
    } else {
      // an element has one byte at least: what is claimed beyond that is refused before memory is
      // taken for it
      require_rest(count, 1);
      values.clear();
      for (std::uint32_t i = 0; i < count; ++i) read(values.emplace_back());
    }
  }
  void read(std::vector<std::uint8_t>& bytes);
  template <class T, std::size_t N>
  void read(std::array<T, N>& values) {
    for (T& value : values) read(value);
  }

  template <class T>
  T number() {
    align(sizeof(T));
    require_rest(1, sizeof(T));
    std::array<char, sizeof(T)> raw{};
    std::memcpy(raw.data(), bytes_.data() + position_, sizeof(T));
    position_ += sizeof(T);
    if (is_swapped_) {
      for (std::size_t i = 0; i < sizeof(T) / 2; ++i) std::swap(raw[i], raw[sizeof(T) - 1 - i]);
    }
    return std::bit_cast<T>(raw);
  }
  std::uint32_t read_count() { return number<std::uint32_t>(); }
  void align(std::size_t size);
  void require_rest(std::uint64_t count, std::size_t size) const;

  std::string_view bytes_;
  Layout layout_;
  bool is_swapped_ = false;  // written in the other byte order
  std::size_t position_ = 0;
  std::size_t origin_ = 0;  // alignment counts from here
};

// Appends the fields of one message, little-endian.
class WireWriter {
 public:
  explicit WireWriter(Layout layout);

  Layout layout() const { return layout_; }

  template <class... Fields>
  void operator()(const Fields&... values) {
    (write(values), ...);
  }
  std::string take() { return std::move(bytes_); }

 private:
  template <class T>
  void write(const T& value) {
    if constexpr (std::is_same_v<T, bool>) {
      number(static_cast<std::uint8_t>(value));
    } else if constexpr (std::is_arithmetic_v<T>) {
      number(value);
    } else {
      // fields() lists references, which a reader fills in; here they are only read
      fields(*this, const_cast<T&>(value));
    }
  }
  void write(const std::string& text);
  template <class T>
  void write(const std::vector<T>& values) {
    number(static_cast<std::uint32_t>(values.size()));
    for (const T& value : values) write(value);
  }
  void write(const std::vector<std::uint8_t>& bytes);
  template <class T, std::size_t N>
  void write(const std::array<T, N>& values) {
    for (const T& value : values) write(value);
  }
  template <class T>
  void number(T value) {
    static_assert(std::endian::native == std::endian::little);
    align(sizeof(T));
    const auto raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
    bytes_.append(raw.data(), raw.size());
  }
  void align(std::size_t size);

  Layout layout_;
  std::string bytes_;
  std::size_t origin_ = 0;
};

template <class Message>
Message read_message(std::string_view bytes, Layout layout) {
  Message message;
  WireReader wire(bytes, layout);
  fields(wire, message);
  return message;
}

template <class Message>
std::string write_message(const Message& message, Layout layout) {
  WireWriter wire(layout);
  wire(message);
  return wire.take();
}

}  // namespace samewhere::messages
