#pragma once

#include <string>

#include <samewhere/core/config.hpp>

namespace samewhere::input {

struct Config {
  std::string camera;         // path of a camera file; empty: the one that lies with the images
  double fps = 0.0;           // of recordings without stamps; 0: the format's own
  double depth_factor = 0.0;  // depth units per metre; 0: the format's own
  double max_stamp_difference_s = 0.02;
  bool depth = true;
  bool realtime = false;  // of a camera, or of a video that is played, the newest frame
  // No setting but the caller's word: whether a calibration that cannot be read ends the run. Where
  // it does not, the recording's own is warned of and left out.
  bool needs_calibration = true;
};

inline void visit_fields(Config& config, core::FieldVisitor& visit) {
  visit("camera", config.camera,
        {.help = "camera file to use instead of the recording's own; empty: its own"});
  visit("fps", config.fps,
        {.help = "frames per second where there are no stamps; 0: 12 for HoloLens, 30 for others",
         .min = 0.0,
         .max = 10000.0});
  visit("depth_factor", config.depth_factor,
        {.help = "depth units per metre; 0: 5000 for TUM RGB-D, 1000 for others",
         .min = 0.0,
         .max = 1e6});
  visit("max_stamp_difference_s", config.max_stamp_difference_s,
        {.help = "largest distance in time of pictures that make one frame, s",
         .min = 0.0,
         .max = 1.0});
  visit("depth", config.depth,
        {.help = "whether depth images are read; without them a recording is monocular"});
  visit("realtime", config.realtime,
        {.help = "a camera, or a video that is played at its own pace: always the newest frame; "
                 "what comes too fast is dropped, so that two runs need not agree"});
}

}  // namespace samewhere::input
