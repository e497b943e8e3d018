#pragma once

#include <cstdint>
#include <span>

namespace samewhere::features {

// Hamming distance of two descriptors of kDescriptorBytes, bits. The processor's own instruction
// counts, where it has one.
int distance_bits(const unsigned char* a, const unsigned char* b);

// The same from one descriptor to each of bits.size() that lie one behind the other: several times
// faster than one by one.
void distances_bits(const unsigned char* one, const unsigned char* all,
                    std::span<std::int16_t> bits);

}  // namespace samewhere::features
