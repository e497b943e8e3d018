#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>

#include <opencv2/core/mat.hpp>

#include <samewhere/input/video_decoder.hpp>

namespace samewhere::input {

// The plugin that reads videos, cameras and the rarer formats of pictures, loaded when the first of
// them is opened.

// Where it is: beside the program or library that holds this code, or under its prefix in
// lib/samewhere (Debian: lib/x86_64-linux-gnu/samewhere).
std::filesystem::path video_plugin_path();

// Throws InputError if the plugin cannot be loaded, or if `video` is no video or camera that it
// reads.
std::unique_ptr<VideoDecoder> open_decoder(const std::filesystem::path& video, bool is_camera,
                                           const std::filesystem::path& plugin);

// The picture in the bytes of a file, as it is stored; false if they are none that is read. Throws
// InputError if the plugin cannot be loaded.
bool decode_by_plugin(const unsigned char* bytes, std::size_t num_bytes, cv::Mat& image);

}  // namespace samewhere::input
