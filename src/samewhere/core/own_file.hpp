#pragma once

#include <filesystem>

namespace samewhere::core {

// The shared library or the program that holds this code, with links followed; empty: not known.
std::filesystem::path own_file();

}  // namespace samewhere::core
