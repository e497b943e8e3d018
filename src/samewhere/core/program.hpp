#pragma once

#include <functional>
#include <string>

namespace samewhere::core {

// Exit codes that scripts rely on.
inline constexpr int kDone = 0;
inline constexpr int kBadInput = 2;
inline constexpr int kBrokenPromise = 3;
inline constexpr int kInterruptedExit = 130;

// "NAME: MESSAGE" on stderr, one line that a terminal only shows (core/printable.hpp), whatever the
// message holds and however long it is. Returns `exit_code`.
int complain(const std::string& name, const std::string& message, int exit_code);

// A line on stderr that is no result: where to look, what is waited for.
void note(const std::string& message);

// All that main() does around the work: warnings go to stderr under the program's name, since
// results alone go to stdout; OpenCV keeps to one thread, so that the same bits come out on any
// number of cores. Returns what `work` returns, kBadInput with one line for an InputError,
// kInterruptedExit for Interrupted, kBrokenPromise with one line for any other exception. What was
// printed and cannot be written turns kDone into kBadInput, with one line; without one where the
// reader of a pipe has gone.
int run_program(const std::string& name, const std::function<int()>& work) noexcept;

}  // namespace samewhere::core
