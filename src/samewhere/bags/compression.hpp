#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include <samewhere/bags/bag.hpp>

namespace samewhere::bags {

// More than any recorder writes as one chunk; one that claims more is refused before memory is
// taken for it.
inline constexpr std::uint64_t kMaxChunkSize = std::uint64_t{512} << 20;

// The bytes that were packed as "lz4" (its frame format), "zstd", "bz2", or "", "none": those
// themselves. Throws InputError, without the name of the file, if the method is another one, the
// bytes are damaged, or they are not `size` bytes, at most kMaxChunkSize.
std::string decompress(std::string_view packed, std::string_view method, std::uint64_t size);

std::string compress(std::string_view bytes, Compression method);

// As a chunk's header names it: "", "lz4", "zstd", "bz2".
std::string_view name_of(Compression method);

// CRC-32 of ISO 3309, as zlib has it.
std::uint32_t crc32_of(std::string_view bytes, std::uint32_t crc_before = 0);

}  // namespace samewhere::bags
