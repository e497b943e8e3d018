#pragma once

#include <filesystem>
#include <vector>

#include <samewhere/input/recording.hpp>

namespace samewhere::input {

// Gives the frames the depth images of a folder, by the names of both: the same but for the ending;
// or with the same last number (rgb_0001.png, depth_0001.png); or, where both are times
// (name_stamps.hpp), the nearest in time, at most max_difference_s apart; or, if there are as many,
// by position. The way that most frames have a partner by is taken. Frames without one have no
// depth and are warned of. Throws InputError if that is so of more than half.
void attach_depth_folder(const std::filesystem::path& folder, double max_difference_s,
                         std::vector<FrameFiles>& frames);

}  // namespace samewhere::input
