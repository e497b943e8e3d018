#include <algorithm>

#include <fmt/format.h>

#include <samewhere/evaluate/statistics.hpp>
#include <samewhere/paper/table_cells.hpp>

namespace samewhere::paper {

std::string mean_cell(const std::vector<double>& values, int num_digits) {
  if (values.empty()) return "-";
  const auto [mean, deviation] = evaluate::mean_and_deviation(values);
  const std::string text = fmt::format("{:.{}f}", mean, num_digits);
  return values.size() == 1 ? text : fmt::format("{} ± {:.{}f}", text, deviation, num_digits);
}

std::string false_share(int num_false, int num_classified) {
  if (num_classified == 0) return "no loop";
  if (num_false > 0) {
    return fmt::format("{} of {} false ({:.1f} %)", num_false, num_classified,
                       100.0 * num_false / num_classified);
  }
  return fmt::format("0 of {} false, at most {:.1f} % at 95 %", num_classified,
                     std::min(100.0, 300.0 / num_classified));
}

}  // namespace samewhere::paper
