#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace samewhere::twin {

// What the camera measures beside the picture.
enum class Sensors : std::uint8_t { kRgbd, kStereo, kMono };

// Which building and how it is walked, read from "twin:PRESET?seed=3&similarity=0.9".
struct Spec {
  std::string preset;
  std::uint64_t seed = 1;   // looks, decoration and the wobble of the walk
  double similarity = 0.8;  // 0: every place has its own looks, 1: only wear and numbers differ
  double speed = 1.0;       // times the usual one of the preset
  int people = 0;           // walking about
  double stray_m = 0.0;     // key `stray`: largest lateral offset from the middle of the way
  Sensors sensors = Sensors::kRgbd;  // key `camera`
  // Another building of the same design: the same walls, walk and common looks, but all that is a
  // place's own drawn anew. 0: the first.
  int copy = 0;
};

struct Preset {
  std::string_view name;
  std::string_view what;  // one line
};

// In the order in which they are shown.
std::span<const Preset> list_presets();

bool is_twin_spec(std::string_view text);

// Throws InputError naming the part that is wrong and what was expected: unknown preset or key, a
// key given twice, a value outside its range.
Spec parse_spec(const std::string& text);

// The spec with every key in a fixed order, but `stray` and `copy` only where not 0: equal for
// equal specs, and parse_spec reads it back.
std::string canonical_text(const Spec& spec);

}  // namespace samewhere::twin
