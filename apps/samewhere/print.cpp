#include "print.hpp"

#include <algorithm>

#include <samewhere/core/printable.hpp>
#include <samewhere/core/terminal.hpp>

namespace samewhere::app {

void print_figures(const std::vector<report::Figure>& figures) {
  std::size_t width = 0;
  for (const auto& figure : figures) width = std::max(width, figure.name.size());
  for (const auto& figure : figures) {
    core::print("  {:<{}}  {}\n", figure.name, width,
                core::printable_line(figure.value, core::kMaxMessage));
  }
}

}  // namespace samewhere::app
