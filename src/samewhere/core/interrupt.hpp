#pragma once

#include <exception>

namespace samewhere::core {

// After this, the first Ctrl-C (SIGINT), SIGTERM or SIGHUP (its terminal is closed; not under
// `nohup`) only sets a flag: long loops look at it between frames, stop, and their files are
// finished. A second SIGINT or SIGTERM ends the process at once. One that was caught before is
// forgotten.
void catch_interrupts();
bool is_interrupted();

// Ends work that is worth nothing unless it is whole.
class Interrupted : public std::exception {
 public:
  const char* what() const noexcept override { return "interrupted"; }
};
// Throws Interrupted after the first Ctrl-C.
void stop_if_interrupted();

}  // namespace samewhere::core
