#pragma once

#include <cstdint>
#include <string_view>

namespace samewhere::core {

// FNV-1a (Fowler, Noll and Vo) of the bytes, 64 bits: detects damaged or different content. Not
// cryptographic: no protection against deliberate changes.
std::uint64_t checksum(std::string_view bytes);

}  // namespace samewhere::core
