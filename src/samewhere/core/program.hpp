#pragma once

#include <functional>
#include <string>

namespace samewhere::core {

// Exit codes that scripts rely on.
inline constexpr int kDone = 0;
inline constexpr int kBadInput = 2;
inline constexpr int kBrokenPromise = 3;
inline constexpr int kInterruptedExit = 130;

// "NAME: MESSAGE" on stderr, one line whatever the message holds. Returns `exit_code`.
int complain(const std::string& name, std::string message, int exit_code);

// All that main() does around the work: warnings go to stderr under the program's name, since
// results alone go to stdout; OpenCV keeps to one thread, so that the same bits come out on any
// number of cores. Returns what `work` returns, kBadInput with one line for an InputError,
// kInterruptedExit for Interrupted, kBrokenPromise with one line for any other exception.
int run_program(const std::string& name, const std::function<int()>& work) noexcept;

}  // namespace samewhere::core
