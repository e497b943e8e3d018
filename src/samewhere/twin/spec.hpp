#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace samewhere::twin {

// Which building, read from "twin:PRESET?seed=3&similarity=0.9".
struct Spec {
  std::string preset;
  std::uint64_t seed = 1;   // textures, decoration and the wobble of the walk
  double similarity = 0.8;  // 0: every door has its own looks, 1: only wear and numbers differ
};

bool is_twin_spec(std::string_view text);

// Throws InputError naming the part that is wrong and what was expected: unknown preset or key, a
// key given twice, a value outside its range.
Spec parse_spec(const std::string& text);

}  // namespace samewhere::twin
