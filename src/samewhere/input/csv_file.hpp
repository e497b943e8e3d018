#pragma once

#include <filesystem>
#include <vector>

#include <samewhere/core/text_file.hpp>

namespace samewhere::input {

// All lines of a CSV file but the blank ones and those that begin with '#', cut into words at the
// commas (where a line has none: at semicolons, or else at white space); white space around a word
// is dropped. Throws InputError as core::read_text.
std::vector<core::TextLine> read_csv_lines(const std::filesystem::path& path);

}  // namespace samewhere::input
