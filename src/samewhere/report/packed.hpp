#pragma once

#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include <nlohmann/json.hpp>

#include <samewhere/report/jpeg.hpp>
#include <samewhere/report/little_endian.hpp>

namespace samewhere::report {

// The name of the typed array that JavaScript reads such numbers with.
template <class T>
constexpr std::string_view name_of_type() {
  if constexpr (std::is_same_v<T, float>) return "Float32Array";
  if constexpr (std::is_same_v<T, std::uint8_t>) return "Uint8Array";
  if constexpr (std::is_same_v<T, std::uint16_t>) return "Uint16Array";
  if constexpr (std::is_same_v<T, std::int16_t>) return "Int16Array";
  if constexpr (std::is_same_v<T, std::uint32_t>) return "Uint32Array";
}

// Numbers as an object of JSON for the report page: type, columns, and base64 of the little-endian
// values, row by row.
template <class T>
nlohmann::ordered_json packed(const std::vector<T>& values, int columns = 1) {
  static_assert(!name_of_type<T>().empty());
  std::string bytes;
  bytes.reserve(values.size() * sizeof(T));
  for (const T value : values) append_little_endian(bytes, value);
  return {{"type", name_of_type<T>()}, {"columns", columns}, {"base64", base64(bytes)}};
}

}  // namespace samewhere::report
