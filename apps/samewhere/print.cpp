#include "print.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace samewhere::app {

void print_figures(const std::vector<report::Figure>& figures) {
  std::size_t width = 0;
  for (const auto& figure : figures) width = std::max(width, figure.name.size());
  for (const auto& figure : figures) fmt::print("  {:<{}}  {}\n", figure.name, width, figure.value);
}

}  // namespace samewhere::app
