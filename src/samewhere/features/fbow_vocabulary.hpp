#pragma once

#include <filesystem>
#include <string_view>

#include <samewhere/features/vocabulary_tree.hpp>

namespace samewhere::features {

// Whether the bytes begin as a file of FBoW does.
bool looks_like_fbow(std::string_view bytes);

// A vocabulary that FBoW has written, little-endian: signature (u64); 120 bytes of sizes; blocks of
// equal size, the root's children in block 0. A block: number of children (u16), its descriptors,
// then for each child the number of its block, or a set highest bit and the number of its word
// (u32), and its weight (float). `path` is for messages. Throws InputError on a file that is cut
// short, damaged or of other descriptors than 32 bytes.
ForeignTree read_fbow(std::string_view bytes, const std::filesystem::path& path);

}  // namespace samewhere::features
