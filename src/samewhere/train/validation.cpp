#include <algorithm>
#include <cstddef>
#include <cstdlib>

#include <opencv2/imgproc.hpp>

#include <samewhere/core/random.hpp>
#include <samewhere/core/similarity.hpp>
#include <samewhere/describe/config.hpp>
#include <samewhere/describe/hog.hpp>
#include <samewhere/train/examples.hpp>
#include <samewhere/train/validation.hpp>

namespace samewhere::train {
namespace {

constexpr int kMaxNeighbour = 4;  // places in the order

// Index of the code most like `code`: all are of length 1.
int nearest(const std::vector<std::vector<float>>& codes, const std::vector<float>& code) {
  std::vector<float> similarity;
  for (const auto& other : codes) similarity.push_back(core::dot(other, code));
  return static_cast<int>(std::max_element(similarity.begin(), similarity.end()) -
                          similarity.begin());
}

}  // namespace

double recognition(const ImageSet& images, const Split& split, const Config& config,
                   const Encode& encode) {
  Config warped = config;
  warped.warp = true;
  const auto view = [&](int i) -> const cv::Mat& {
    return images.views[static_cast<std::size_t>(split.validation[static_cast<std::size_t>(i)])];
  };
  const int num_views = static_cast<int>(split.validation.size());
  std::vector<std::vector<float>> codes;
  for (int i = 0; i < num_views; ++i) {
    codes.push_back(core::unit(encode(encoder_input(view(i), config.input_size))));
  }
  int num_found = 0;
  for (int i = 0; i < num_views; ++i) {
    core::Random random(core::seed_of(static_cast<std::uint64_t>(config.seed), "recognition",
                                      static_cast<std::uint64_t>(i)));
    const auto code = core::unit(encode(distorted_input(view(i), warped, random)));
    if (std::abs(nearest(codes, code) - i) <= kMaxNeighbour) ++num_found;
  }
  return static_cast<double>(num_found) / std::max(num_views, 1);
}

std::vector<float> hog_of_input(const cv::Mat& input) {
  const describe::HogConfig hog;
  cv::Mat small;
  cv::resize(input, small, cv::Size(hog.width_px, hog.height_px), 0.0, 0.0, cv::INTER_AREA);
  small.convertTo(small, CV_8U, 255.0);
  return describe::hog(small, hog.cell_px, hog.weak_gradient);
}

}  // namespace samewhere::train
