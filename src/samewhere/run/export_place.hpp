#pragma once

#include <filesystem>
#include <string_view>

namespace samewhere::run {

// In the folder of an export: what it is, for a person, and that it may be replaced.
inline constexpr const char* kExportNote = "samewhere-export.txt";

// Throws InputError if the folder of an export holds an earlier one that may not be replaced, other
// files, or the recording `source`, or is no folder.
void check_export_folder(const std::filesystem::path& folder, const std::filesystem::path& source,
                         bool replaces_earlier);

// Makes the folder, without what an earlier export wrote into it (sparse/, images/, depth/,
// transforms.json, sparse_points.ply), and writes `note` into it. Throws InputError if it cannot.
void begin_export_folder(const std::filesystem::path& folder, std::string_view note);

// Throws InputError if a file that may not be replaced has the name, the name is that of the map
// itself or of a folder, or the file's folder cannot be written.
void check_export_file(const std::filesystem::path& file, const std::filesystem::path& map,
                       bool replaces_earlier);

}  // namespace samewhere::run
