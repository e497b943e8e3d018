#pragma once

#include <string>

#include <samewhere/core/config.hpp>

namespace samewhere::twin {

// Settings of the rendered buildings. Which building is said by the source (spec.hpp).
struct Config {
  bool ideal_depth = false;  // exact depth at every pixel instead of the sensor model
  std::string shake;         // file of a recorded trajectory; empty: made up (recorded_shake.hpp)
  int num_frames = 0;        // render only the first frames of the walk; 0 = all
  int num_workers = 0;       // threads that render; 0: one per processor. The frames are the same
};

inline void visit_fields(Config& config, core::FieldVisitor& visit) {
  visit("ideal_depth", config.ideal_depth,
        {.help = "exact depth at every pixel, without a sensor model"});
  visit("shake", config.shake,
        {.help = "TUM trajectory of a hand-held camera, z up: its steps, sway and looking around "
                 "replace the made-up ones of a person; empty: made up"});
  visit("num_frames", config.num_frames,
        {.help = "render the first frames of the walk only; 0: all", .min = 0});
  visit("num_workers", config.num_workers,
        {.help = "rendering threads, 0: one per processor; the frames are identical",
         .min = 0,
         .max = 64});
}

}  // namespace samewhere::twin
