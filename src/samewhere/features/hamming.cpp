#include <array>
#include <cstdint>
#include <cstring>

#include <samewhere/features/describe.hpp>
#include <samewhere/features/hamming.hpp>

// Compiled for processors that count bits with one instruction, which not every x86-64 has.
#ifdef __x86_64__
#define SAMEWHERE_WITH_POPCNT [[gnu::target("popcnt")]]
#else
#define SAMEWHERE_WITH_POPCNT
#endif

namespace samewhere::features {
namespace {

using Parts = std::array<std::uint64_t, kDescriptorBytes / sizeof(std::uint64_t)>;

[[gnu::always_inline]] inline Parts parts_of(const unsigned char* descriptor) {
  Parts parts;
  std::memcpy(parts.data(), descriptor, kDescriptorBytes);
  return parts;
}

[[gnu::always_inline]] inline int count_different(const Parts& one, const unsigned char* other) {
  const Parts parts = parts_of(other);
  int bits = 0;
  for (std::size_t i = 0; i < parts.size(); ++i) bits += __builtin_popcountll(one[i] ^ parts[i]);
  return bits;
}

[[gnu::always_inline]] inline void count_all(const unsigned char* one, const unsigned char* all,
                                             std::span<std::int16_t> bits) {
  const Parts parts = parts_of(one);
  for (std::int16_t& to_one : bits) {
    to_one = static_cast<std::int16_t>(count_different(parts, all));
    all += kDescriptorBytes;
  }
}

bool has_popcnt() {
#ifdef __x86_64__
  static const bool has = __builtin_cpu_supports("popcnt") != 0;
  return has;
#else
  return false;
#endif
}

SAMEWHERE_WITH_POPCNT int distance_with_popcnt(const unsigned char* a, const unsigned char* b) {
  return count_different(parts_of(a), b);
}

SAMEWHERE_WITH_POPCNT void all_with_popcnt(const unsigned char* one, const unsigned char* all,
                                           std::span<std::int16_t> bits) {
  count_all(one, all, bits);
}

}  // namespace

int distance_bits(const unsigned char* a, const unsigned char* b) {
  return has_popcnt() ? distance_with_popcnt(a, b) : count_different(parts_of(a), b);
}

void distances_bits(const unsigned char* one, const unsigned char* all,
                    std::span<std::int16_t> bits) {
  return has_popcnt() ? all_with_popcnt(one, all, bits) : count_all(one, all, bits);
}

}  // namespace samewhere::features
