#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace samewhere::core {

// The whole file as bytes. Throws InputError if it cannot be read.
std::string read_file(const std::filesystem::path& path);

// Writes the whole file or nothing: into a temporary file beside it, then renamed; of a link that
// which it leads to. A pipe or a terminal is written to as it is. Throws InputError naming the path
// and the system's reason (no space left, permission denied).
void write_file(const std::filesystem::path& path, std::string_view content);

// Makes the folder and checks by writing into it that files can be made. Throws InputError.
void make_writable_folder(const std::filesystem::path& folder);

}  // namespace samewhere::core
