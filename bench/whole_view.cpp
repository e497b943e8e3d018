#include "whole_view.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include <samewhere/core/errors.hpp>

namespace samewhere::bench {
namespace {

constexpr int kSide_px = 224;
constexpr double kMiddle = 127.5;

cv::dnn::Net read_network(const std::filesystem::path& onnx_file) {
  if (!std::filesystem::is_regular_file(onnx_file)) {
    throw core::InputError(fmt::format(
        "{}: there is no such file; expected MobileNetV2 as ONNX (--network)", onnx_file.string()));
  }
  try {
    return cv::dnn::readNetFromONNX(onnx_file.string());
  } catch (const cv::Exception& error) {
    throw core::InputError(fmt::format("{}: OpenCV cannot read it as an ONNX network ({})",
                                       onnx_file.string(), error.err));
  }
}

}  // namespace

MobileNet::MobileNet(const std::filesystem::path& onnx_file) : network_(read_network(onnx_file)) {}

std::vector<float> MobileNet::describe(const cv::Mat& bgr) {
  const bool swap_to_rgb = true;
  network_.setInput(cv::dnn::blobFromImage(bgr, 1.0 / kMiddle, cv::Size(kSide_px, kSide_px),
                                           cv::Scalar::all(kMiddle), swap_to_rgb));
  const cv::Mat embedding = network_.forward("embedding").reshape(1, 1);
  std::vector<float> vector(embedding.begin<float>(), embedding.end<float>());
  const float length = std::sqrt(dot(vector, vector));
  if (length > 0.0F) {
    for (float& value : vector) value /= length;
  }
  return vector;
}

float dot(const std::vector<float>& a, const std::vector<float>& b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0F);
}

std::vector<int> most_alike(const std::vector<std::vector<float>>& vectors, int query,
                            const std::vector<int>& offered, int count) {
  std::vector<std::pair<float, int>> ranked;
  ranked.reserve(offered.size());
  for (const int match : offered) {
    // negated, so that the usual order puts the most alike first and breaks ties by index
    ranked.emplace_back(
        -dot(vectors[static_cast<std::size_t>(query)], vectors[static_cast<std::size_t>(match)]),
        match);
  }
  const std::size_t num_kept = std::min(ranked.size(), static_cast<std::size_t>(count));
  std::partial_sort(ranked.begin(), ranked.begin() + static_cast<std::ptrdiff_t>(num_kept),
                    ranked.end());
  std::vector<int> best(num_kept);
  for (std::size_t i = 0; i < num_kept; ++i) best[i] = ranked[i].second;
  return best;
}

}  // namespace samewhere::bench
