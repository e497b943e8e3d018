#pragma once

#include <filesystem>
#include <vector>

#include <samewhere/report/record.hpp>

namespace samewhere::pipeline {

// The figures of a finished run, measured anew from the files in its folder against the truth that
// comes with its source (config.yaml says which). Recognition alone is told by its matches.txt.
// Throws InputError if a file is missing or broken, or if the source is no longer there.
std::vector<report::Figure> evaluate_folder(const std::filesystem::path& folder);

}  // namespace samewhere::pipeline
