#pragma once

#include <filesystem>
#include <memory>
#include <string_view>

#include <samewhere/core/source.hpp>
#include <samewhere/input/config.hpp>

namespace samewhere::input {

// Whether the name ends as those of videos do: .mp4, .avi, .mkv, .mov and so on.
bool is_video_name(std::string_view name);

// Whether there is a device such as /dev/video0 at that path.
bool is_camera_device(const std::filesystem::path& path);

// Where the plugin lies that reads videos: beside the running program.
std::filesystem::path video_plugin_path();

// A video file (is_video), or a camera (is_live). Frames are pictures of one camera; input.camera
// calibrates it. Stamps are those of the file or the driver, or position / input.fps where that is
// given; one that does not rise is one frame after the last. A video is not turned as a telephone
// would show it: the calibration belongs to the sensor. info().num_frames is what the file claims,
// 0 if it does not say. After its last picture next() throws InputError if the file ends clearly
// before what it claims: it is cut or damaged. Pictures that are missing though the file lasts as
// long as it claims are warned of in the log. Neither can be told of a file that claims nothing, or
// whose claim is read off its last bytes (MPEG, Ogg).
//
// Throws InputError if the plugin is not there, if `path` is no video or the camera cannot be
// opened, or if it gives no picture; and as FileSource does for the camera file.
std::unique_ptr<core::Source> open_video(const std::filesystem::path& path, const Config& config,
                                         const std::filesystem::path& plugin = video_plugin_path());

}  // namespace samewhere::input
