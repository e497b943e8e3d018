#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include <samewhere/core/text_file.hpp>
#include <samewhere/input/recording.hpp>

namespace samewhere::input {

// stamp = frame number in the name / fps. Throws InputError naming the file if a name has no number
// or the numbers do not rise.
void stamp_by_number(std::vector<FrameFiles>& frames, double fps);

// Gives every frame its depth image; `depths` are the paths where they lie, one per frame. Frames
// whose file is missing have none and are warned of. Throws InputError naming the first one if that
// is so of more than half.
void attach_depth(std::vector<FrameFiles>& frames,
                  const std::vector<std::filesystem::path>& depths);

// A pose file with one line a frame, `pose_of` each: the n-th belongs to the n-th frame. Lines that
// cannot be read are left out, as are those beyond the frames; both, and frames without a line, are
// warned of.
core::Trajectory read_pose_lines(const std::filesystem::path& file,
                                 const std::vector<FrameFiles>& frames,
                                 const std::function<core::Rigid3(const core::TextLine&)>& pose_of);

}  // namespace samewhere::input
