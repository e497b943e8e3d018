#pragma once

#include <functional>
#include <string>

#include <CLI/CLI.hpp>

#include "table.hpp"

namespace samewhere::bench {

// Parses the arguments, then does the work. Bad input is one line on stderr and exit code 2, a bug
// of ours 3. OpenCV runs on one thread meanwhile, so that the same figures come out everywhere.
int run_program(CLI::App& app, int argc, char** argv, const std::function<void()>& work);

// The table on stdout, and as CSV in `csv_file` unless that is empty. Throws InputError.
void publish(const Table& table, const std::string& csv_file);

}  // namespace samewhere::bench
