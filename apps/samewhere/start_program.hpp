#pragma once

#include <string>
#include <vector>

namespace samewhere::app {

// Becomes the program of this name, which lies beside this one where it was built: it needs
// libraries that this one does without. Throws core::InputError for `command` with `advice` if it
// cannot be started.
[[noreturn]] void start_program(const std::string& name, std::vector<std::string> arguments,
                                const std::string& command, const std::string& advice);

}  // namespace samewhere::app
