#pragma once

#include <filesystem>
#include <vector>

#include <samewhere/input/config.hpp>
#include <samewhere/input/recording.hpp>

namespace samewhere::input {

// Lists of pictures with stamps (list_file.hpp), as TUM RGB-D and OpenLORIS-Scene have them. What
// is listed but not there is left out and warned of.

// One frame a line of the list of colour images. Throws InputError naming file and line if the list
// cannot be read or is empty, or if more than half of the images are missing.
std::vector<FrameFiles> read_stamped_frames(const std::filesystem::path& list);

// Gives frames the depth images of a list, nearest in time. Throws InputError as above, and if no
// frame has one within config.max_stamp_difference_s; a warning if fewer than half have.
void attach_stamped_depth(const std::filesystem::path& list, const Config& config,
                          std::vector<FrameFiles>& frames);

}  // namespace samewhere::input
