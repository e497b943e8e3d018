#pragma once

#include <vector>

#include <samewhere/input/recording.hpp>

namespace samewhere::input {

// stamp = frame number in the name / fps. Throws InputError naming the file if a name has no number
// or the numbers do not rise.
void stamp_by_number(std::vector<FrameFiles>& frames, double fps);

// Gives every frame its depth image; `depths` are the paths where they lie, one per frame. Throws
// InputError naming the first one that is missing.
void attach_depth(std::vector<FrameFiles>& frames,
                  const std::vector<std::filesystem::path>& depths);

}  // namespace samewhere::input
