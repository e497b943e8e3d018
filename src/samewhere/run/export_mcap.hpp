#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include <samewhere/pipeline/config.hpp>
#include <samewhere/scene/map_file.hpp>

namespace samewhere::run {

// What of a finished run was written as messages.
struct McapCounts {
  std::size_t num_poses = 0;
  std::size_t num_points = 0;
  std::size_t num_verdicts = 0;
  std::size_t num_pictures = 0;
  std::string grid;  // its size, or why there is none
};

// A finished run as an MCAP file of ROS 2 messages, in the order of the frames' stamps:
//   /tf, /tf_static     map -> base_link of each measured frame; base_link -> camera_optical_frame
//   /pose, /path        the same poses; the path once, at the first stamp
//   /map_points         PointCloud2 of the landmarks, x y z rgb, once, at the first stamp
//   /map                OccupancyGrid of the keyframes' depth (dense.*), once, at the first stamp;
//                       none without depth or floor
//   /camera/image/compressed, /camera/camera_info   keyframes, read again from the source
//   /diagnostics        the last verdict on each loop candidate, at its query: OK accepted, WARN
//                       ambiguous or withdrawn, ERROR rejected, with reason and every score
// Axes are those of REP-103: base_link has x forward, y left, z up, and so has the map, whose
// origin is the first keyframe. Pictures as exported to COLMAP, as JPEG. Throws InputError if the
// file cannot be written, and as SourceFrames does.
McapCounts write_mcap_of_run(const scene::StoredMap& stored, int session,
                             const pipeline::Config& config, const std::filesystem::path& file);

}  // namespace samewhere::run
