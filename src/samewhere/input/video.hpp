#pragma once

#include <filesystem>
#include <memory>
#include <string_view>

#include <samewhere/core/source.hpp>
#include <samewhere/input/config.hpp>
#include <samewhere/input/video_plugin.hpp>

namespace samewhere::input {

// Whether the name ends as those of videos do: .mp4, .avi, .mkv, .mov and so on.
bool is_video_name(std::string_view name);

// Whether there is a device such as /dev/video0 at that path.
bool is_camera_device(const std::filesystem::path& path);

// The camera file beside a video: NAME.camera.txt, with or without the ending of the video, or
// camera.txt in its folder. Empty: there is none.
std::filesystem::path camera_file_beside(const std::filesystem::path& video);

// A video file (is_video), or a camera (is_live). Frames are pictures of one camera; input.camera
// calibrates it. Stamps are those of the file or the driver, or position / input.fps where that is
// given; one that does not rise is one frame after the last. A video is not turned as a telephone
// would show it: the calibration belongs to the sensor. info().num_frames is what the file claims,
// 0 if it does not say. A file that ends clearly before what it claims is cut or damaged: that, and
// pictures that are missing though the file lasts as long as it claims, is warned of in the log
// after its last picture. Neither can be told of a file that claims nothing, or whose claim is read
// off its last bytes (MPEG, Ogg). Of a rotation that the file notes the log says that it is not
// applied.
// Without input.camera the camera file beside a video is used, if it is there and belongs to
// pictures of its size, and the log says so: NAME.camera.txt or camera.txt.
//
// Throws InputError if the plugin is not there, if `path` is no video or the camera cannot be
// opened, or if it gives no picture; and as FileSource does for the camera file.
std::unique_ptr<core::Source> open_video(const std::filesystem::path& path, const Config& config,
                                         const std::filesystem::path& plugin = video_plugin_path());

}  // namespace samewhere::input
