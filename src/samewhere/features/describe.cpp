#include <cmath>

#include <opencv2/core/hal/intrin.hpp>
#include <opencv2/imgproc.hpp>

#include <samewhere/features/describe.hpp>
#include <samewhere/features/pattern.hpp>

namespace samewhere::features {
namespace {

constexpr int kRadius_px = kPatchRadius_px;
constexpr int kDiameter_px = 2 * kRadius_px + 1;
constexpr int kRowLanes = 32;  // a row of the disc, filled up to whole vectors
constexpr std::size_t kNumTests = std::size_t{8} * kDescriptorBytes;

constexpr auto kNumWeights = static_cast<std::size_t>(kDiameter_px) * kRowLanes;

// What each pixel of the square around the disc weighs in the two moments: its offset from the
// centre, 0 outside the disc.
struct MomentWeights {
  alignas(16) std::array<std::int16_t, kNumWeights> x{};
  alignas(16) std::array<std::int16_t, kNumWeights> y{};
};

MomentWeights moment_weights() {
  MomentWeights weights;
  for (int y = -kRadius_px; y <= kRadius_px; ++y) {
    for (int x = -kRadius_px; x <= kRadius_px; ++x) {
      if (x * x + y * y > kRadius_px * (kRadius_px + 1)) continue;
      const auto at = static_cast<std::size_t>((y + kRadius_px) * kRowLanes + x + kRadius_px);
      weights.x[at] = static_cast<std::int16_t>(x);
      weights.y[at] = static_cast<std::int16_t>(y);
    }
  }
  return weights;
}

// The pixels compared: test i compares point i with point i + kNumTests.
struct Points {
  std::array<float, 2 * kNumTests> x{};
  std::array<float, 2 * kNumTests> y{};
};

constexpr Points points_of_pattern() {
  Points points;
  for (std::size_t i = 0; i < kNumTests; ++i) {
    points.x[i] = kPattern[i].a_x;
    points.y[i] = kPattern[i].a_y;
    points.x[i + kNumTests] = kPattern[i].b_x;
    points.y[i + kNumTests] = kPattern[i].b_y;
  }
  return points;
}

constexpr Points kPoints = points_of_pattern();

// How far each point of the turned pattern lies from the first byte of the picture.
void turn(const Eigen::Vector2f& centre_px, float angle_rad, int row_bytes,
          std::array<int, 2 * kNumTests>& offsets) {
  const float cosine = std::cos(angle_rad);
  const float sine = std::sin(angle_rad);
  // half a pixel more: cutting off the fraction rounds, as nothing is negative here
  const float centre_x = centre_px.x() + 0.5F;
  const float centre_y = centre_px.y() + 0.5F;
  for (std::size_t i = 0; i < offsets.size(); ++i) {
    const float x = centre_x + cosine * kPoints.x[i] - sine * kPoints.y[i];
    const float y = centre_y + sine * kPoints.x[i] + cosine * kPoints.y[i];
    offsets[i] = static_cast<int>(y) * row_bytes + static_cast<int>(x);
  }
}

}  // namespace

float orientation_rad(const cv::Mat& image, const Eigen::Vector2f& pixel) {
  static const MomentWeights weights = moment_weights();
  const int left = static_cast<int>(std::lround(pixel.x())) - kRadius_px;
  const int top = static_cast<int>(std::lround(pixel.y())) - kRadius_px;
  cv::v_int32x4 moment_x = cv::v_setzero_s32();
  cv::v_int32x4 moment_y = cv::v_setzero_s32();
  for (int row = 0; row < kDiameter_px; ++row) {
    const std::uint8_t* pixels = image.ptr(top + row) + left;
    for (int lane = 0; lane < kRowLanes; lane += 8) {
      const auto at = static_cast<std::size_t>(row * kRowLanes + lane);
      const cv::v_int16x8 grey = cv::v_reinterpret_as_s16(cv::v_load_expand(pixels + lane));
      moment_x += cv::v_dotprod(grey, cv::v_load_aligned(&weights.x[at]));
      moment_y += cv::v_dotprod(grey, cv::v_load_aligned(&weights.y[at]));
    }
  }
  return std::atan2(static_cast<float>(cv::v_reduce_sum(moment_y)),
                    static_cast<float>(cv::v_reduce_sum(moment_x)));
}

void describe(const cv::Mat& blurred, const Eigen::Vector2f& pixel, float angle_rad,
              std::uint8_t* descriptor) {
  std::array<int, 2 * kNumTests> offsets{};
  turn(pixel, angle_rad, static_cast<int>(blurred.step), offsets);
  const std::uint8_t* pixels = blurred.ptr();
  for (std::size_t byte = 0; byte < kDescriptorBytes; ++byte) {
    unsigned bits = 0;
    for (std::size_t bit = 0; bit < 8; ++bit) {
      const std::size_t test = 8 * byte + bit;
      const bool is_darker = pixels[offsets[test]] < pixels[offsets[test + kNumTests]];
      bits |= static_cast<unsigned>(is_darker) << bit;
    }
    descriptor[byte] = static_cast<std::uint8_t>(bits);
  }
}

cv::Mat blurred_for_descriptors(const cv::Mat& image) {
  cv::Mat blurred;
  cv::GaussianBlur(image, blurred, {7, 7}, 2.0, 2.0, cv::BORDER_REFLECT_101);
  return blurred;
}

}  // namespace samewhere::features
