#pragma once

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

// Makes sure that no file is opened under the number of a standard stream: of one that was closed
// when the program started, reading and writing fail.
void occupy_standard_streams();

// Whether all that was printed is written; where not, the system's error number.
int finish_standard_output();

}  // namespace samewhere::core
