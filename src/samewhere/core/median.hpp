#pragma once

#include <algorithm>
#include <optional>
#include <vector>

namespace samewhere::core {

// The value in the middle once they are sorted; of an even count the upper of the two in the
// middle, so that the answer is always one of the values, never a mean. Nothing of no values. None
// may be NaN.
template <class T>
std::optional<T> median(std::vector<T> values) {
  if (values.empty()) return std::nullopt;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace samewhere::core
