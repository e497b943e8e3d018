#pragma once

#include <cstdint>
#include <string_view>

namespace samewhere::core {

// FNV-1a (Fowler, Noll and Vo) of the bytes, 64 bits: tells damaged or different content apart, but
// not from somebody who means harm.
std::uint64_t checksum(std::string_view bytes);

}  // namespace samewhere::core
