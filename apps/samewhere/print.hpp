#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include <samewhere/report/record.hpp>

namespace samewhere::app {

// Names and values in two aligned columns on stdout.
void print_figures(const std::vector<report::Figure>& figures);

// Output of the metrics of a command.
struct FigureOptions {
  std::string json;       // file, or "-" for stdout instead of the text
  bool is_quiet = false;  // neither text nor progress

  bool prints_text() const { return !is_quiet && json != "-"; }
};

void add_json_option(CLI::App& command, FigureOptions& options);
void add_quiet_flag(CLI::App& command, FigureOptions& options);

// As JSON if --json is given (report/figures_json.hpp). Throws InputError if the file cannot
// be written.
void write_json(const std::string& title, const std::vector<report::Figure>& figures,
                const FigureOptions& options);

}  // namespace samewhere::app
