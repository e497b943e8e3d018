#pragma once

#include <filesystem>
#include <memory>

#include <samewhere/core/source.hpp>
#include <samewhere/input/config.hpp>
#include <samewhere/input/recording.hpp>

namespace samewhere::input {

// The recording at `source`: a folder, whose format is told by what is in it (formats.hpp), a text
// file that lists images, a bag (bag_source.hpp), a video by its name or because it is neither text
// nor a picture, or a camera's device (video.hpp). Frames are read one at a time, when asked for.
// Throws InputError if there is nothing known there, or if anything that text files say is missing
// or broken; a bad image is reported by next().
std::unique_ptr<core::Source> open_source(const std::filesystem::path& source,
                                          const Config& config);

// Whether open_source takes what is there for a video or a camera.
bool is_video(const std::filesystem::path& source);

// Where the pictures of a folder or list lie, for readers of other kinds. Throws
// InputError as above.
Recording read_recording(const std::filesystem::path& source, const Config& config);

}  // namespace samewhere::input
