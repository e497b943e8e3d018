#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <samewhere/twin/building/noise.hpp>
#include <samewhere/twin/render/photograph.hpp>

namespace samewhere::twin {
namespace {

// From linear light to the 8 bits of a picture.
class ToneCurve {
 public:
  ToneCurve() {
    for (std::size_t i = 0; i < levels_.size(); ++i) {
      const float light = static_cast<float>(i) / kStepsPerUnit;
      // linear up to the shoulder, then ever flatter: lamps are white, not cut out
      const float rolled =
          light < kShoulder
              ? light
              : kShoulder + (1.0F - kShoulder) *
                                (1.0F - std::exp((kShoulder - light) / (1.0F - kShoulder)));
      levels_[i] = 255.0F * with_contrast(gamma_coded(rolled));
    }
  }

  float level(float light) const {
    // what is nearly black is made black; noise may take it below zero
    constexpr float kBlack = 0.005F;
    const float step = std::clamp((light - kBlack) / (1.0F - kBlack) * kStepsPerUnit, 0.0F,
                                  static_cast<float>(levels_.size() - 1));
    return levels_[static_cast<std::size_t>(step)];
  }

 private:
  // sRGB: straight near black, where a power would make mountains of the noise
  static float gamma_coded(float light) {
    return light < 0.0031308F ? 12.92F * light : 1.055F * std::pow(light, 1.0F / 2.4F) - 0.055F;
  }

  // as cameras do: darker shades, lighter lights
  static float with_contrast(float level) {
    constexpr float kStrength = 0.45F;
    return lerp(level, smoothstep(level), kStrength);
  }

  static constexpr float kShoulder = 0.7F;
  static constexpr float kStepsPerUnit = 4096.0F;
  std::array<float, 16384> levels_{};
};

// A row of the picture after the lens: a bell three pixels wide, [1 23 1] / 25 along rows and
// columns.
void blur_row(const cv::Mat& radiance, int y, std::vector<cv::Vec3f>& result) {
  constexpr float kSide = 0.04F;
  constexpr float kMiddle = 1.0F - 2.0F * kSide;
  const auto* const above = radiance.ptr<cv::Vec3f>(std::max(y - 1, 0));
  const auto* const here = radiance.ptr<cv::Vec3f>(y);
  const auto* const below = radiance.ptr<cv::Vec3f>(std::min(y + 1, radiance.rows - 1));
  const auto blurred_down = [&](int x) {
    return cv::Vec3f(kSide * (above[x] + below[x]) + kMiddle * here[x]);
  };
  cv::Vec3f before = blurred_down(0);
  cv::Vec3f now = before;
  for (int x = 0; x < radiance.cols; ++x) {
    const cv::Vec3f after = blurred_down(std::min(x + 1, radiance.cols - 1));
    result[static_cast<std::size_t>(x)] = kSide * (before + after) + kMiddle * now;
    before = now;
    now = after;
  }
}

// Light that reaches a pixel over what reaches the middle.
float vignette(float x_px, float y_px, const cv::Size& size) {
  constexpr float kLossInCorner = 0.25F;
  const float dx = 2.0F * x_px / static_cast<float>(size.width) - 1.0F;
  const float dy = 2.0F * y_px / static_cast<float>(size.height) - 1.0F;
  return 1.0F - kLossInCorner * 0.5F * (dx * dx + dy * dy);
}

// Standard deviation of the noise on a signal.
class SensorNoise {
 public:
  explicit SensorNoise(float gain)
      : shot_(kShotNoise * gain), read_(kReadNoise * kReadNoise * gain * gain) {}

  float deviation(float signal) const { return std::sqrt(shot_ * std::max(signal, 0.0F) + read_); }

 private:
  // what the camera's own smoothing leaves of it
  static constexpr float kShotNoise = 1.5e-5F;  // one over the photons that would be white
  static constexpr float kReadNoise = 1.5e-4F;

  float shot_;  // variance over signal
  float read_;  // variance
};

// Colours as cameras like them: further from grey.
cv::Vec3f with_strong_colours(const cv::Vec3f& light) {
  constexpr float kStrength = 1.1F;
  const float grey = 0.11F * light[0] + 0.59F * light[1] + 0.30F * light[2];
  const cv::Vec3f neutral(grey, grey, grey);
  return neutral + kStrength * (light - neutral);
}

// Noise of the three channels of a pixel, of standard deviation 1: mostly common to them.
std::array<float, 3> pixel_noise(std::uint64_t seed, std::uint64_t pixel) {
  constexpr float kCommon = 0.78F;
  constexpr float kOwn = 0.62F;
  const std::uint64_t first = scramble(seed + 2 * pixel);
  const std::uint64_t second = scramble(seed + 2 * pixel + 1);
  const float common = kCommon * nearly_gaussian(static_cast<std::uint32_t>(first));
  return {common + kOwn * nearly_gaussian(static_cast<std::uint32_t>(first >> 32)),
          common + kOwn * nearly_gaussian(static_cast<std::uint32_t>(second)),
          common + kOwn * nearly_gaussian(static_cast<std::uint32_t>(second >> 32))};
}

}  // namespace

cv::Mat photograph(const cv::Mat& radiance, const Exposure& exposure, std::uint64_t seed) {
  static const ToneCurve tone;
  const SensorNoise sensor(exposure.gain);
  std::vector<cv::Vec3f> light(static_cast<std::size_t>(radiance.cols));
  cv::Mat picture(radiance.size(), CV_8UC3);
  for (int y = 0; y < radiance.rows; ++y) {
    blur_row(radiance, y, light);
    auto* const level = picture.ptr<cv::Vec3b>(y);
    for (int x = 0; x < radiance.cols; ++x) {
      const auto pixel = static_cast<std::uint64_t>(y) * static_cast<std::uint64_t>(radiance.cols) +
                         static_cast<std::uint64_t>(x);
      const float scale = exposure.signal_per_radiance() *
                          vignette(static_cast<float>(x), static_cast<float>(y), radiance.size());
      const std::array<float, 3> noise = pixel_noise(seed, pixel);
      const cv::Vec3f signals = scale * with_strong_colours(light[static_cast<std::size_t>(x)]);
      for (int channel = 0; channel < 3; ++channel) {
        const float signal = signals[channel];
        level[x][channel] = cv::saturate_cast<std::uint8_t>(tone.level(
            signal + sensor.deviation(signal) * noise[static_cast<std::size_t>(channel)]));
      }
    }
  }
  return picture;
}

}  // namespace samewhere::twin
