#include <algorithm>
#include <cmath>

#include <samewhere/twin/render/exposure.hpp>

namespace samewhere::twin {
namespace {

// Shutter first: a short one blurs less, gain costs noise.
Exposure exposure_of(float signal_per_radiance) {
  constexpr float kMinDuration_s = 0.002F;
  constexpr float kMaxDuration_s = 0.010F;
  constexpr float kMaxGain = 24.0F;
  const float needed_s =
      signal_per_radiance / Exposure{.duration_s = 1.0F, .gain = 1.0F}.signal_per_radiance();
  const float duration_s = std::clamp(needed_s, kMinDuration_s, kMaxDuration_s);
  return {.duration_s = duration_s, .gain = std::clamp(needed_s / duration_s, 1.0F, kMaxGain)};
}

}  // namespace

std::vector<Exposure> automatic_exposures(std::span<const float> mean_radiances,
                                          double frame_rate_hz) {
  constexpr float kMeanSignal = 0.30F;
  constexpr double kLag_s = 0.4;
  const auto step = static_cast<float>(1.0 - std::exp(-1.0 / (kLag_s * frame_rate_hz)));
  std::vector<Exposure> exposures;
  float log_scale = 0.0F;
  bool is_settled = false;
  for (const float mean : mean_radiances) {
    if (mean > 0.0F) {
      const float wanted = std::log(kMeanSignal / mean);
      log_scale = is_settled ? log_scale + step * (wanted - log_scale) : wanted;
      is_settled = true;
    }
    exposures.push_back(exposure_of(std::exp(log_scale)));
  }
  return exposures;
}

}  // namespace samewhere::twin
