#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace samewhere::core {

// Text on standard output, as printable_text() gives it. Never throws for output that cannot be
// written: run_program() looks at the end whether all was, so that a run's files are written first.
void print_text(std::string_view text);

// The same, formatted.
template <class... Args>
void print(fmt::format_string<Args...> format, Args&&... args) {
  print_text(fmt::format(format, std::forward<Args>(args)...));
}

// Columns of the terminal that stderr is; 0 if it is none or does not tell.
std::size_t stderr_width();

// A line for stderr as it is shown there: on a terminal it replaces an unfinished progress line,
// and is coloured unless the variable NO_COLOR is set or TERM is `dumb`.
enum class Severity { kInfo, kWarning, kError };
std::string line_for_stderr(std::string_view line, Severity severity);

// Makes sure that no file is opened under the number of a standard stream: of one that was closed
// when the program started, reading and writing fail.
void occupy_standard_streams();

// Whether all that was printed is written; where not, the system's error number.
int finish_standard_output();

}  // namespace samewhere::core
