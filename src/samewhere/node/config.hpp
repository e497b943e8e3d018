#pragma once

#include <string>
#include <utility>
#include <vector>

#include <samewhere/core/config.hpp>

namespace samewhere::node {

enum class Cameras { kMono, kDepth, kStereo };

struct Config {
  Cameras cameras = Cameras::kMono;
  bool is_rectified = false;
  bool is_compressed = false;
  bool is_reliable = false;
  double depth_units_per_m = 1000.0;
  double frame_rate_hz = 0.0;
  double pair_tolerance_s = 0.01;
  int queue_frames = 5;
  bool never_wait = true;
  std::string map_frame = "map";
  std::string odom_frame = "odom";
  std::string base_frame = "base_link";
  double tf_wait_s = 1.0;
  bool odometry_from_tf = false;
  double map_to_odom_postdate_s = 0.1;
  double map_period_s = 1.0;
  int max_landmarks = 200000;
  double grid_period_s = 5.0;
};

inline void visit_images(Config& config, core::FieldVisitor& visit) {
  visit("cameras", config.cameras,
        {.help = "one camera, one with depth, or a stereo pair",
         .choices = {"mono", "depth", "stereo"}});
  visit("rectified", config.is_rectified,
        {.help = "images are the rectified ones, which P of camera_info describes"});
  visit("compressed", config.is_compressed,
        {.help = "camera images come as CompressedImage (JPEG or PNG)"});
  visit("reliable_images", config.is_reliable,
        {.help = "images are asked for reliably, for a network that loses packets; the camera's "
                 "node has to offer it (ROS 2)"});
  visit("depth_units_per_m", config.depth_units_per_m,
        {.help = "units of depth 16UC1 per metre", .min = 0.001, .max = 1e6});
  visit(
      "frame_rate_hz", config.frame_rate_hz,
      {.help = "frames per second; 0: measured over the first frames", .min = 0.0, .max = 1000.0});
  visit("pair_tolerance_s", config.pair_tolerance_s,
        {.help = "largest difference of the stamps of a pair of images, seconds; less than half a "
                 "frame period",
         .min = 0.0,
         .max = 1.0});
  visit("queue_frames", config.queue_frames,
        {.help = "frames that may be waiting; above, the oldest is dropped and counted",
         .min = 1,
         .max = 10000});
  visit("never_wait", config.never_wait,
        {.help = "tracking does not wait for mapping; a session cannot be repeated to the bit"});
}

inline void visit_fields(Config& config, core::FieldVisitor& visit) {
  visit_images(config, visit);
  visit("map_frame", config.map_frame, {.help = "name of the frame of the map (REP-105)"});
  visit("odom_frame", config.odom_frame, {.help = "name of the frame of the odometry"});
  visit("base_frame", config.base_frame,
        {.help = "name of the robot's frame, connected to the camera by /tf_static"});
  visit("tf_wait_s", config.tf_wait_s,
        {.help = "longest wait for the camera's transform in /tf_static, seconds of the images",
         .min = 0.0,
         .max = 100.0});
  visit("odometry_from_tf", config.odometry_from_tf,
        {.help = "odom_frame -> base_frame comes from /tf; it is not published"});
  visit("map_to_odom_postdate_s", config.map_to_odom_postdate_s,
        {.help = "how far map_frame -> odom_frame is dated ahead of its image, seconds",
         .min = 0.0,
         .max = 10.0});
  visit("map_period_s", config.map_period_s,
        {.help = "least time between two paths, landmark clouds or states, seconds",
         .min = 0.0,
         .max = 1000.0});
  visit("max_landmarks", config.max_landmarks,
        {.help = "most landmarks in a cloud; above, every n-th", .min = 1, .max = 1e8});
  visit("grid_period_s", config.grid_period_s,
        {.help = "least time between two occupancy grids, seconds; 0: none (needs depth images)",
         .min = 0.0,
         .max = 1e6});
}

// `node.key=value` of the assignments goes into the first, the others are settings of SLAM. Throws
// core::InputError.
std::pair<Config, std::vector<std::string>> config_from(
    const std::vector<std::string>& assignments);

// Markdown: the keys with default, range and meaning.
std::string config_table();

}  // namespace samewhere::node
