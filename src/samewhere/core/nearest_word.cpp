#include <algorithm>
#include <utility>
#include <vector>

#include <samewhere/core/nearest_word.hpp>

namespace samewhere::core {

int edit_distance(std::string_view a, std::string_view b) {
  // rows of the table that are still needed: of the prefix of `a` of length i, i - 1 and i - 2
  std::vector<int> row(b.size() + 1);
  for (std::size_t j = 0; j < row.size(); ++j) row[j] = static_cast<int>(j);
  std::vector<int> before(row.size());
  std::vector<int> two_before(row.size());
  for (std::size_t i = 1; i <= a.size(); ++i) {
    two_before = std::exchange(before, row);
    row[0] = static_cast<int>(i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const int replaced = before[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({before[j] + 1, row[j - 1] + 1, replaced});
      const bool is_swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (is_swapped) row[j] = std::min(row[j], two_before[j - 2] + 1);
    }
  }
  return row.back();
}

std::optional<std::string> nearest_word(std::string_view word, std::span<const std::string> known) {
  constexpr int kMaxDistance = 2;
  std::optional<std::string> nearest;
  int least = kMaxDistance + 1;
  for (const std::string& each : known) {
    const bool is_too_long = word.size() > each.size() + kMaxDistance;
    const int distance = is_too_long ? least : edit_distance(word, each);
    if (distance >= least || 2 * distance >= static_cast<int>(each.size())) continue;
    least = distance;
    nearest = each;
  }
  return nearest;
}

}  // namespace samewhere::core
