#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <opencv2/core/types.hpp>

#include <samewhere/pipeline/config.hpp>
#include <samewhere/scene/map_version.hpp>

namespace samewhere::run {

// Where the pictures of keyframes go.
struct PicturePlan {
  std::filesystem::path images;  // folder of the pictures
  std::filesystem::path depth;   // and of their depth; empty: not wanted
  bool is_undistorted = false;   // by the calibration of the keyframes, with the same intrinsics
  std::function<void()> begin = {};  // called with the first picture, before it is written
};

struct WrittenPictures {
  cv::Size size_px;
  std::vector<bool> has_depth;  // by keyframe: whether its depth was written
};

// The name of a frame's picture and of its depth: "frame-000012.png", by position in the source.
std::string picture_name(core::FrameId frame);

// Reads the source of a run once more and writes the picture of camera 0 of each keyframe as PNG,
// as the source gives it (rectified, straightened), and its depth as 16-bit PNG in millimetres, 0 =
// unknown or beyond 65.5 m. `keyframes` are of one session, by frame, and not empty. Progress on
// stderr. Throws InputError if the source is gone or another one, or a file cannot be written;
// Interrupted after Ctrl-C.
WrittenPictures write_pictures(const std::vector<const scene::Keyframe*>& keyframes,
                               const pipeline::Config& config, const PicturePlan& plan);

}  // namespace samewhere::run
