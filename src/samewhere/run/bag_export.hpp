#pragma once

#include <filesystem>
#include <string>

#include <samewhere/bags/bag.hpp>
#include <samewhere/core/source.hpp>

namespace samewhere::run {

// How a recording is written as a bag.
struct BagOptions {
  bags::BagFormat format = bags::BagFormat::kMcap;
  bags::Compression compression = bags::Compression::kNone;  // of chunks
  bool is_jpeg = false;  // pictures as CompressedImage; else as Image
};

// Writes all frames of a source as messages: /camera/color/image_raw with camera_info, depth
// (32FC1, metres) as /camera/aligned_depth_to_color/image_raw; of a pair /camera/left and
// /camera/right; IMU as /imu/data, ground truth as /ground_truth/odometry, where things sit as
// /tf_static. Frames are those of the source, in the axes of camera 0's optical frame,
// "camera_optical_frame". What is read back is the same: stamps to the nanosecond, pixels, depth,
// calibration.
//
// `file` ends in .mcap, .db3 or .bag, or has no ending: then it becomes a folder of rosbag2 with
// its metadata.yaml. Returns the number of frames. Throws InputError if something has that name, if
// it cannot be written, and what the source throws.
int write_bag(core::Source& source, const std::filesystem::path& file, const BagOptions& options,
              bool is_quiet);

// The format of a file by its ending; of a folder MCAP. Throws InputError for another ending.
bags::BagFormat bag_format_of(const std::filesystem::path& file);

}  // namespace samewhere::run
