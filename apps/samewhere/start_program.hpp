#pragma once

#include <optional>
#include <string>
#include <vector>

namespace samewhere::app {

// Becomes the program of this name, which lies beside this one where it was built: it needs
// libraries that this one does without. Throws core::InputError for `command` with `advice` if it
// cannot be started.
[[noreturn]] void start_program(const std::string& name, std::vector<std::string> arguments,
                                const std::string& command, const std::string& advice);

// Runs `python3 -m MODULE ARGUMENTS...` with the Python package of this program's build or
// installation, and waits. What it prints is dropped. Nothing if it succeeds, else which command
// tells why not.
std::optional<std::string> run_python(const std::string& module,
                                      const std::vector<std::string>& arguments);

}  // namespace samewhere::app
