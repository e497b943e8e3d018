#pragma once

#include <functional>
#include <string>

#include <CLI/CLI.hpp>

#include <samewhere/report/table.hpp>

namespace samewhere::bench {

using report::Table;

// Names the program, says what it is for, adds its options; returns the work that is done once they
// are read.
using SetUp = std::function<void()> (*)(CLI::App& app);

// All that main() does: returns the exit code. Bad input is one line on stderr and 2, a bug of ours
// 3. OpenCV runs on one thread, so that the same figures come out everywhere.
int run_program(int argc, char** argv, SetUp set_up) noexcept;

// The table on stdout, and as CSV in `csv_file` unless that is empty. Throws InputError.
void publish(const Table& table, const std::string& csv_file);

}  // namespace samewhere::bench
