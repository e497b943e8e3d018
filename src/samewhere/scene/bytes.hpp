#pragma once

#include <array>
#include <bit>
#include <cstring>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include <opencv2/core/mat.hpp>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/ids.hpp>
#include <samewhere/core/rigid3.hpp>

namespace samewhere::scene {

static_assert(std::endian::native == std::endian::little, "bytes are written as memory has them");

template <class T>
concept Plain = std::is_arithmetic_v<T> || std::is_enum_v<T>;

// Turns values into bytes that ByteReader turns back, bit by bit: little-endian, lists after their
// length, optional parts after a byte that says whether they are there. A struct is written as its
// `fields(archive, value)` lists it; one such list serves writer and reader.
class ByteWriter {
 public:
  template <class T>
  using Value = const T;

  template <class... T>
  void operator()(const T&... values) {
    (put(values), ...);
  }
  // A list whose length both sides know.
  template <class T>
  void row(const T* values, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) put(values[i]);
  }

  // What only some rows have, at their end: nothing is written where it is not there.
  template <class T>
  void at_end(const std::optional<T>& value) {
    if (value) put(*value);
  }

  const std::string& bytes() const { return bytes_; }

 private:
  template <Plain T>
  void put(const T& value) {
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  template <class Tag>
  void put(const core::Id<Tag>& id) {
    put(id.value());
  }
  template <class T, std::size_t N>
  void put(const std::array<T, N>& values) {
    row(values.data(), N);
  }
  template <class T, class Memory>
  void put(const std::vector<T, Memory>& values) {
    put(std::uint64_t{values.size()});
    row(values.data(), values.size());
  }
  template <class T>
  void put(const std::optional<T>& value) {
    put(static_cast<std::uint8_t>(value.has_value()));
    if (value) put(*value);
  }
  template <class Scalar, int kRows, int kColumns>
  void put(const Eigen::Matrix<Scalar, kRows, kColumns>& matrix) {
    row(matrix.data(), static_cast<std::size_t>(matrix.size()));
  }
  void put(const core::Rigid3& a_from_b) {
    put(a_from_b.rotation.coeffs());
    put(a_from_b.translation);
  }
  // Bytes, one row after the other.
  void put(const cv::Mat& bytes) {
    core::require(bytes.empty() || bytes.type() == CV_8U, "a matrix of bytes is written");
    (*this)(bytes.rows, bytes.cols);
    for (int y = 0; y < bytes.rows; ++y) row(bytes.ptr(y), static_cast<std::size_t>(bytes.cols));
  }
  template <class T>
  requires(!Plain<T>) void put(const T& value) { fields(*this, value); }

  std::string bytes_;
};

// What a value takes that holds no list and nothing optional.
template <class T>
std::size_t min_bytes() {
  static const std::size_t size = [] {
    ByteWriter writer;
    writer(T{});
    return writer.bytes().size();
  }();
  return size;
}

// Throws InputError, which begins with `where`, if the bytes end too early or too late.
class ByteReader {
 public:
  template <class T>
  using Value = T;

  ByteReader(std::string_view bytes, std::string where) : left_(bytes), where_(std::move(where)) {}

  template <class... T>
  void operator()(T&... values) {
    (get(values), ...);
  }
  template <class T>
  void row(T* values, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) get(values[i]);
  }
  template <class T>
  void at_end(std::optional<T>& value) {
    value.reset();
    if (!left_.empty()) get(value.emplace());
  }
  void finish() const {
    if (!left_.empty()) damaged("holds more than expected");
  }

 private:
  [[noreturn]] void damaged(const char* how) const {
    throw core::InputError(where_ + " is damaged: it " + how);
  }
  std::string_view take(std::size_t size) {
    if (size > left_.size()) damaged("is cut short");
    const std::string_view taken = left_.substr(0, size);
    left_.remove_prefix(size);
    return taken;
  }
  // Of elements that take so many bytes each at least: no memory is taken for what is not there.
  std::size_t checked_count(std::uint64_t count, std::size_t min_bytes) const {
    if (count > left_.size() / min_bytes) damaged("is cut short");
    return static_cast<std::size_t>(count);
  }

  template <Plain T>
  void get(T& value) {
    std::memcpy(&value, take(sizeof value).data(), sizeof value);
  }
  void get(bool& value) {
    std::uint8_t byte = 0;
    get(byte);
    if (byte > 1) damaged("holds a flag that is neither 0 nor 1");
    value = byte != 0;
  }
  template <class Tag>
  void get(core::Id<Tag>& id) {
    std::uint64_t value = 0;
    get(value);
    id = core::Id<Tag>::from_value(value);
  }
  template <class T, std::size_t N>
  void get(std::array<T, N>& values) {
    row(values.data(), N);
  }
  template <class T, class Memory>
  void get(std::vector<T, Memory>& values) {
    std::uint64_t count = 0;
    get(count);
    values.resize(checked_count(count, min_bytes<T>()));
    row(values.data(), values.size());
  }
  template <class T>
  void get(std::optional<T>& value) {
    bool is_there = false;
    get(is_there);
    value.reset();
    if (is_there) get(value.emplace());
  }
  template <class Scalar, int kRows, int kColumns>
  void get(Eigen::Matrix<Scalar, kRows, kColumns>& matrix) {
    row(matrix.data(), static_cast<std::size_t>(matrix.size()));
  }
  void get(core::Rigid3& a_from_b) {
    get(a_from_b.rotation.coeffs());
    get(a_from_b.translation);
  }
  void get(cv::Mat& bytes) {
    int rows = 0;
    int columns = 0;
    (*this)(rows, columns);
    if (rows < 0 || columns < 0) damaged("holds a matrix of negative size");
    if (columns == 0) rows = 0;
    checked_count(static_cast<std::uint64_t>(rows) * static_cast<std::uint64_t>(columns), 1);
    bytes = cv::Mat(rows, columns, CV_8U);
    for (int y = 0; y < rows; ++y) row(bytes.ptr(y), static_cast<std::size_t>(columns));
  }
  template <class T>
  requires(!Plain<T>) void get(T& value) { fields(*this, value); }

  std::string_view left_;
  std::string where_;
};

// A value of the archive's kind: read-only for a writer.
template <class Archive, class T>
using Value = typename Archive::template Value<T>;

}  // namespace samewhere::scene
