#pragma once

#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <samewhere/report/record.hpp>

namespace samewhere::report {

// A metric with its numbers: those of `values` that are arithmetic.
//   figure("revisits closed", "{} of {}", num_closed, num_revisits)
template <class... T>
Figure figure(std::string name, fmt::format_string<T...> format, T&&... values) {
  std::vector<double> numbers;
  const auto add = [&numbers](const auto& value) {
    using Type = std::remove_cvref_t<decltype(value)>;
    if constexpr (std::is_arithmetic_v<Type>) numbers.push_back(static_cast<double>(value));
  };
  (add(values), ...);
  return {std::move(name), fmt::format(format, std::forward<T>(values)...), std::move(numbers)};
}

}  // namespace samewhere::report
