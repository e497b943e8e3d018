#pragma once

#include <filesystem>

namespace samewhere::report {

// A folder for results is new, empty, holds other things, or is one of an earlier run, which its
// config.yaml says. Throws InputError if it is the recording's, or files in it have the names of
// results but are of no run: somebody's recording or map.
void require_folder_for_results(const std::filesystem::path& folder,
                                const std::filesystem::path& source);

// What an earlier run left there would be taken for this one's: it goes, with what `samewhere
// dense` made of it. Other files stay, and so does `known_map` if it is one of these. Throws
// InputError if another program is writing to its map.
void remove_old_results(const std::filesystem::path& folder,
                        const std::filesystem::path& known_map);

}  // namespace samewhere::report
