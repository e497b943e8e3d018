#include <algorithm>

#include <samewhere/core/errors.hpp>

namespace samewhere::core {
namespace {

std::string without_zero_bytes(std::string message) {
  std::replace(message.begin(), message.end(), '\0', '?');
  return message;
}

}  // namespace

InputError::InputError(const std::string& message)
    : std::runtime_error(without_zero_bytes(message)) {}

void require(bool condition, std::string_view promise) {
  if (!condition) throw ContractError("promise broken: " + std::string(promise));
}

}  // namespace samewhere::core
