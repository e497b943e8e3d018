#pragma once

#include <filesystem>

namespace samewhere::scene {

// Rewrites a map file of the version before in the current version: map, header, descriptors,
// ledger and thumbnails. It replaces the file once it is complete; until then, and after an error,
// the file is unchanged. False: it is of the current version already. Throws InputError as
// MapFile::open and MapFile::commit do, and if another program writes to the file.
bool upgrade_map_file(const std::filesystem::path& path);

}  // namespace samewhere::scene
