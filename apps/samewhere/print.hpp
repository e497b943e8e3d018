#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include <samewhere/report/record.hpp>

namespace samewhere::app {

// Names and values in two aligned columns on stdout.
void print_figures(const std::vector<report::Figure>& figures);

// Where the figures of a command go.
struct FigureOptions {
  std::string json;       // file, or "-" for stdout in place of what a person reads
  bool is_quiet = false;  // nothing for a person, neither figures nor progress

  bool is_for_person() const { return !is_quiet && json != "-"; }
};

void add_json_option(CLI::App& command, FigureOptions& options);
void add_quiet_flag(CLI::App& command, FigureOptions& options);

// As JSON where they are asked for (report/figures_json.hpp). Throws InputError if the file cannot
// be written.
void write_json(const std::string& title, const std::vector<report::Figure>& figures,
                const FigureOptions& options);

}  // namespace samewhere::app
