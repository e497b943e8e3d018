#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

namespace samewhere::core {

// Bad outside input: a file, a value, an option. The message is one line for a person and names the
// file or key, the value found and what was expected. Caught once, in main: printed on stderr, exit
// code 2.
class InputError : public std::runtime_error {
 public:
  // A zero byte in the message, such as one of a damaged list, becomes '?': what() would end there.
  explicit InputError(const std::string& message);
};

// A broken contract in our own code: a bug. Exit code 3.
class ContractError : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

// Throws ContractError("promise broken: ...") if the condition is false.
void require(bool condition, std::string_view promise);

}  // namespace samewhere::core
