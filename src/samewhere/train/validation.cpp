#include <algorithm>
#include <cstddef>
#include <cstdlib>

#include <opencv2/imgproc.hpp>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/random.hpp>
#include <samewhere/core/similarity.hpp>
#include <samewhere/describe/config.hpp>
#include <samewhere/describe/hog.hpp>
#include <samewhere/train/examples.hpp>
#include <samewhere/train/validation.hpp>

namespace samewhere::train {
namespace {

constexpr int kMaxNeighbour = 4;  // places in the order of a source

// Index of the code most like `code`: all are of length 1.
std::size_t nearest(const Codes& codes, const std::vector<float>& code) {
  std::vector<float> similarity;
  for (const auto& other : codes) similarity.push_back(core::dot(other, code));
  return static_cast<std::size_t>(std::max_element(similarity.begin(), similarity.end()) -
                                  similarity.begin());
}

bool are_neighbours(const ImageSet& images, int a, int b) {
  return std::abs(a - b) <= kMaxNeighbour && source_of(images, a) == source_of(images, b);
}

}  // namespace

double share_found(const ImageSet& images, std::span<const int> views, const Codes& codes,
                   const Codes& queries) {
  core::require(!views.empty() && codes.size() == views.size() && queries.size() == views.size(),
                "each view has a code and is asked for once");
  int num_found = 0;
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (are_neighbours(images, views[nearest(codes, queries[i])], views[i])) ++num_found;
  }
  return static_cast<double>(num_found) / static_cast<double>(views.size());
}

double recognition(const ImageSet& images, const Split& split, const Config& config,
                   const Encode& encode) {
  Config warped = config;
  warped.warp = true;
  Codes codes;
  Codes queries;
  for (std::size_t i = 0; i < split.validation.size(); ++i) {
    const cv::Mat& view = images.views[static_cast<std::size_t>(split.validation[i])];
    core::Random random(core::seed_of(static_cast<std::uint64_t>(config.seed), "recognition", i));
    codes.push_back(core::unit(encode(encoder_input(view, config.input_size))));
    queries.push_back(core::unit(encode(distorted_input(view, warped, random))));
  }
  return share_found(images, split.validation, codes, queries);
}

std::vector<float> hog_of_input(const cv::Mat& input) {
  const describe::HogConfig hog;
  cv::Mat small;
  cv::resize(input, small, cv::Size(hog.width_px, hog.height_px), 0.0, 0.0, cv::INTER_AREA);
  small.convertTo(small, CV_8U, 255.0);
  return describe::hog(small, hog.cell_px, hog.weak_gradient);
}

}  // namespace samewhere::train
