#include "print.hpp"

#include <algorithm>

#include <samewhere/core/file.hpp>
#include <samewhere/core/printable.hpp>
#include <samewhere/core/terminal.hpp>
#include <samewhere/report/figures_json.hpp>

namespace samewhere::app {

void print_figures(const std::vector<report::Figure>& figures) {
  std::size_t width = 0;
  for (const auto& figure : figures) width = std::max(width, figure.name.size());
  for (const auto& figure : figures) {
    core::print("  {:<{}}  {}\n", figure.name, width,
                core::printable_line(figure.value, core::kMaxMessage));
  }
}

void add_json_option(CLI::App& command, FigureOptions& options) {
  command.add_option("--json", options.json,
                     "file for the metrics as JSON; - for standard output, instead of the text");
}

void add_quiet_flag(CLI::App& command, FigureOptions& options) {
  command.add_flag("--quiet", options.is_quiet,
                   "print neither metrics nor progress; warnings and errors remain");
}

void write_json(const std::string& title, const std::vector<report::Figure>& figures,
                const FigureOptions& options) {
  if (options.json.empty()) return;
  const std::string text = report::figures_json(title, figures);
  if (options.json == "-") {
    core::print("{}", text);
  } else {
    core::write_file(options.json, text);
  }
}

}  // namespace samewhere::app
