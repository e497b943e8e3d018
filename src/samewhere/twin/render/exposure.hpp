#pragma once

#include <span>
#include <vector>

namespace samewhere::twin {

// How one picture is taken.
struct Exposure {
  float duration_s = 0.01F;  // the shutter is open
  float gain = 1.0F;         // of the sensor over its lowest; noise grows with it

  // What becomes of radiance: a signal of 1 is white.
  float signal_per_radiance() const {
    constexpr float kSensitivity_per_s = 190.0F;
    return kSensitivity_per_s * duration_s * gain;
  }
};

// What an automatic exposure does on a walk past these mean radiances (Renderer::mean_radiance),
// one per frame: it brings their mean to a middle grey, and lags behind as cameras do; the first
// frame is settled. The shutter opens up to 10 ms, what is missing then is made up by gain. Frames
// without light (0) leave it as it is.
std::vector<Exposure> automatic_exposures(std::span<const float> mean_radiances,
                                          double frame_rate_hz);

}  // namespace samewhere::twin
