#pragma once

#include <string>

#include <samewhere/core/config.hpp>

namespace samewhere::input {

struct Config {
  std::string camera;         // path of a camera file; empty: the one that lies with the images
  double fps = 0.0;           // of recordings without stamps; 0: the format's own
  double depth_factor = 0.0;  // depth units per metre; 0: the camera file's or the format's own
  double fov_deg = 0.0;       // horizontal, of a camera without calibration; 0: guessed
  int focal_length_keyframes = 30;  // of the first pass that estimates a guessed focal length
  double max_stamp_difference_s = 0.02;
  std::string topics;  // of a bag: "color=/a depth=/b"; empty: found
  bool depth = true;
  int truth_tolerance_frames = -1;  // of the matrix of same places; -1: as the protocol says
  bool enlarge = true;              // pictures of less than 480 x 360 pixels, in SLAM
  bool realtime = false;            // of a camera, or of a video that is played, the newest frame
  // No setting but the caller's word: whether a calibration that cannot be read ends the run. Where
  // it does not, the recording's own is warned of and left out.
  bool needs_calibration = true;
};

inline void visit_images(Config& config, core::FieldVisitor& visit) {
  visit("depth", config.depth,
        {.help = "depth images are read; false: the recording is treated as monocular"});
  visit("truth_tolerance_frames", config.truth_tolerance_frames,
        {.help = "frames by which each row of the matrix of same places is widened; -1: `info` and "
                 "`bench paper` take it from the protocol of the data set, others 0",
         .min = -1,
         .max = 1000,
         .is_expert = true});
  visit("enlarge", config.enlarge,
        {.help = "`run`: images below 480 x 360 pixels are enlarged to the pixel count of 640 x "
                 "480: corners have whole-pixel coordinates"});
  visit("realtime", config.realtime,
        {.help = "camera or video at its own pace: the newest frame is used, the others are "
                 "dropped; not reproducible"});
}

inline void visit_fields(Config& config, core::FieldVisitor& visit) {
  visit("camera", config.camera,
        {.help = "camera file that replaces the recording's own; empty: the recording's own"});
  visit(
      "fps", config.fps,
      {.help = "frames per second of recordings without stamps; 0: 12 for HoloLens, 30 for others",
       .min = 0.0,
       .max = 10000.0});
  visit(
      "depth_factor", config.depth_factor,
      {.help =
           "depth units per metre; 0: of the camera file, else 5000 for TUM RGB-D, 1000 for others",
       .min = 0.0,
       .max = 1e6});
  visit("fov_deg", config.fov_deg,
        {.help = "horizontal field of view of a camera without calibration, degrees; 0: guessed",
         .min = 0.0,
         .max = 170.0});
  visit(
      "focal_length_keyframes", config.focal_length_keyframes,
      {.help =
           "keyframes of the first pass, which estimates a guessed focal length; 0: no first pass",
       .min = 0,
       .max = 1000});
  visit("max_stamp_difference_s", config.max_stamp_difference_s,
        {.help = "largest time difference of the images of one frame, s", .min = 0.0, .max = 1.0});
  visit("topics", config.topics,
        {.help =
             "topics of a bag by their roles, `color=/a depth=/b`; empty: found by their types and "
             "names"});
  visit_images(config, visit);
}

}  // namespace samewhere::input
