#include <samewhere/core/errors.hpp>

namespace samewhere::core {

void require(bool condition, std::string_view promise) {
  if (!condition) throw ContractError("promise broken: " + std::string(promise));
}

}  // namespace samewhere::core
