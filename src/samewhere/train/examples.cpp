#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <opencv2/imgproc.hpp>

#include <samewhere/core/errors.hpp>
#include <samewhere/describe/autoencoder.hpp>
#include <samewhere/describe/config.hpp>
#include <samewhere/describe/hog.hpp>
#include <samewhere/train/examples.hpp>

namespace samewhere::train {
namespace {

const cv::Size kHogSize_px(160, 120);
constexpr int kHogCell_px = 10;
const cv::Size kPixels_px(80, 60);

constexpr double kMaxCornerShift = 0.25;  // of the side, as the published method
// Photometric changes. Equalisation has undone much of them before, so they are mild.
constexpr double kLightSigma = 0.4;  // of the logarithm, from place to place
constexpr double kMaxLogGain = 0.25;
constexpr double kMaxLogGamma = 0.25;
constexpr double kMaxBias = 0.1;         // of the whole range
constexpr double kMaxNoiseSigma = 0.04;  // of the whole range
constexpr double kMaxBlur_px = 1.2;      // standard deviation
constexpr double kMinBlur_px = 0.3;      // less changes nothing

cv::Mat reduced(const cv::Mat& view, cv::Size size_px) {
  cv::Mat small;
  cv::resize(view, small, size_px, 0.0, 0.0, cv::INTER_AREA);
  return small;
}

// The quadrangle whose corners lie inwards of the view's by up to a quarter of the side fills the
// whole picture: no border has to be invented.
cv::Mat seen_from_elsewhere(const cv::Mat& view, core::Random& random) {
  const auto width = static_cast<float>(view.cols);
  const auto height = static_cast<float>(view.rows);
  const std::array<cv::Point2f, 4> to = {
      {{0.0F, 0.0F}, {width, 0.0F}, {width, height}, {0.0F, height}}};
  std::array<cv::Point2f, 4> from = to;
  for (cv::Point2f& corner : from) {
    const auto dx = static_cast<float>(random.uniform(0.0, kMaxCornerShift)) * width;
    const auto dy = static_cast<float>(random.uniform(0.0, kMaxCornerShift)) * height;
    corner.x += corner.x > 0.0F ? -dx : dx;
    corner.y += corner.y > 0.0F ? -dy : dy;
  }
  cv::Mat warped;
  cv::warpPerspective(view, warped, cv::getPerspectiveTransform(from.data(), to.data()),
                      view.size(), cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  return warped;
}

// Light that falls otherwise: brighter in one part of the view, darker in another, smoothly. What
// equalisation cannot undo.
void light_anew(cv::Mat& input, core::Random& random) {
  const cv::Size size(5, 4);
  cv::Mat lights(size, CV_32F);
  for (int row = 0; row < lights.rows; ++row) {
    for (int column = 0; column < lights.cols; ++column) {
      lights.at<float>(row, column) = static_cast<float>(std::exp(kLightSigma * random.gaussian()));
    }
  }
  constexpr double kDarkest = 0.05;  // the cubic between two lights may swing below 0
  cv::Mat light;
  cv::resize(lights, light, input.size(), 0.0, 0.0, cv::INTER_CUBIC);
  light = cv::max(light, kDarkest);
  const std::vector<cv::Mat> planes(static_cast<std::size_t>(input.channels()), light);
  cv::merge(planes, light);
  input = input.mul(light);
}

// Blur of the lens, then light and exposure, then noise of the sensor, then the range of a picture.
void photograph_again(cv::Mat& input, core::Random& random) {
  const double blur_px = random.uniform(0.0, kMaxBlur_px);
  const auto gain = static_cast<float>(std::exp(random.uniform(-kMaxLogGain, kMaxLogGain)));
  const auto gamma = static_cast<float>(std::exp(random.uniform(-kMaxLogGamma, kMaxLogGamma)));
  const auto bias = static_cast<float>(random.uniform(-kMaxBias, kMaxBias));
  const auto sigma = static_cast<float>(random.uniform(0.0, kMaxNoiseSigma));
  if (blur_px > kMinBlur_px) cv::GaussianBlur(input, input, cv::Size(), blur_px);
  for (int row = 0; row < input.rows; ++row) {
    auto* pixels = input.ptr<float>(row);
    for (int column = 0; column < input.cols * input.channels(); ++column) {
      const float lit = gain * std::pow(pixels[column], gamma) + bias;
      const float noisy = lit + sigma * static_cast<float>(random.gaussian());
      pixels[column] = std::clamp(noisy, 0.0F, 1.0F);
    }
  }
}

}  // namespace

cv::Size input_size_px(InputSize size) {
  switch (size) {
    case InputSize::k120x160:
      return {160, 120};
    case InputSize::k180x240:
      return {240, 180};
    case InputSize::k360x480:
      return {480, 360};
  }
  throw core::ContractError("an input size is one of three");
}

int target_length(Target target) {
  return target == Target::kHog ? describe::hog_length(kHogSize_px, kHogCell_px)
                                : kPixels_px.area();
}

cv::Mat encoder_input(const cv::Mat& view, InputSize size) {
  core::require(view.type() == CV_8UC1, "a view to encode is 8-bit grey");
  return describe::network_input(view, input_size_px(size));
}

cv::Mat distorted_input(const cv::Mat& view, const Config& config, core::Random& random) {
  const cv::Mat seen = config.warp ? seen_from_elsewhere(view, random) : view;
  cv::Mat input = encoder_input(seen, config.input_size);
  light_anew(input, random);
  photograph_again(input, random);
  return input;
}

cv::Mat distorted_picture(const cv::Mat& bgr, core::Random& random) {
  core::require(bgr.type() == CV_8UC3, "a picture to distort is BGR");
  cv::Mat input;
  seen_from_elsewhere(bgr, random).convertTo(input, CV_32F, 1.0 / 255.0);
  light_anew(input, random);
  photograph_again(input, random);
  cv::Mat picture;
  input.convertTo(picture, CV_8U, 255.0);
  return picture;
}

std::vector<float> target_of(const cv::Mat& view, Target target) {
  if (target == Target::kHog) {
    return describe::hog(reduced(view, kHogSize_px), kHogCell_px,
                         describe::HogConfig{}.weak_gradient);
  }
  cv::Mat pixels;
  reduced(view, kPixels_px).convertTo(pixels, CV_32F, 1.0 / 255.0);
  return {pixels.begin<float>(), pixels.end<float>()};
}

TargetScale scale_of_targets(std::span<const cv::Mat> views, std::span<const int> indices,
                             Target target) {
  const auto length = static_cast<std::size_t>(target_length(target));
  std::vector<double> sum(length, 0.0);
  double sum_of_squares = 0.0;
  for (const int index : indices) {
    const std::vector<float> numbers = target_of(views[static_cast<std::size_t>(index)], target);
    for (std::size_t i = 0; i < length; ++i) {
      sum[i] += numbers[i];
      sum_of_squares += static_cast<double>(numbers[i]) * numbers[i];
    }
  }
  const auto count = static_cast<double>(indices.size());
  TargetScale scale;
  double variance = sum_of_squares / (count * static_cast<double>(length));
  for (const double number : sum) {
    const double mean = number / count;
    scale.mean.push_back(static_cast<float>(mean));
    variance -= mean * mean / static_cast<double>(length);
  }
  // views that are all alike have nothing to be scaled
  if (variance > 1e-12) scale.deviation = static_cast<float>(std::sqrt(variance));
  return scale;
}

ExampleMaker::ExampleMaker(const Config& config, const ImageSet& images, const Split& split,
                           TargetScale scale)
    : config_(config),
      views_(images.views),
      pairs_(images, split, config.pairs),
      scale_(std::move(scale)) {}

void ExampleMaker::add(int index, core::Random& random, Batch& batch) const {
  const cv::Mat& view = views_[static_cast<std::size_t>(index)];
  const cv::Mat input = distorted_input(view, config_, random);
  batch.inputs.insert(batch.inputs.end(), input.begin<float>(), input.end<float>());
  const std::vector<float> target = target_of(view, config_.target);
  for (std::size_t i = 0; i < target.size(); ++i) {
    batch.targets.push_back((target[i] - scale_.mean[i]) / scale_.deviation);
  }
  ++batch.num_examples;
}

Batch ExampleMaker::batch(std::span<const int> indices, std::uint64_t seed) const {
  Batch batch;
  for (const int index : indices) {
    core::Random random(core::seed_of(seed, "distort", static_cast<std::uint64_t>(index)));
    add(index, random, batch);
  }
  if (config_.contrast == 0.0) return batch;
  std::vector<int> partners;
  for (const int index : indices) {
    core::Random random(core::seed_of(seed, "partner", static_cast<std::uint64_t>(index)));
    partners.push_back(pairs_.partner(index, random));
    add(partners.back(), random, batch);
  }
  batch.other_places = pairs_.other_places(indices, partners);
  return batch;
}

cv::Mat ExampleMaker::input(int index) const {
  return encoder_input(views_[static_cast<std::size_t>(index)], config_.input_size);
}

}  // namespace samewhere::train
