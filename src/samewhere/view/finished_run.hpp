#pragma once

#include <filesystem>

#include <samewhere/report/html.hpp>

namespace samewhere::view {

// The page of a finished run: its report.html, brought in step with verdicts that were overridden
// since (`samewhere ledger RUN reject N` and `force N`). Throws InputError if a file is missing or
// damaged.
report::PageBlocks page_of_run(const std::filesystem::path& folder);

// The page of a map file alone: landmarks, keyframes and loop candidates. Throws InputError as
// scene::MapFile does, and if it has no keyframe.
report::PageBlocks page_of_map(const std::filesystem::path& file);

// Whether verdicts of the run can be overridden: it has a map of its own.
bool may_override(const std::filesystem::path& folder);

}  // namespace samewhere::view
