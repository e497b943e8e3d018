#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/train/examples.hpp>
#include <samewhere/train/network_plan.hpp>

namespace samewhere::train {
namespace {

constexpr int kNumPositions = 4 * 6;

void check_code_size(int code_size) {
  if (code_size % kNumPositions == 0) return;
  const int below = code_size / kNumPositions * kNumPositions;
  throw core::InputError(
      fmt::format("code_size = {}: expected a multiple of {} (4 x 6 positions), such as {} or {}",
                  code_size, kNumPositions, below, below + kNumPositions));
}

}  // namespace

NetworkPlan plan_network(const Config& config) {
  check_code_size(config.code_size);
  const cv::Size input_px = input_size_px(config.input_size);
  const int stride_px = input_px.height / 60;
  const int wide = 4 * config.channels;
  return {.input_px = input_px,
          .convolutions = {{1, config.channels, 2 * stride_px + 1, stride_px, stride_px},
                           {config.channels, wide, 3, 1, 1},
                           {wide, wide, 3, 1, 1},
                           {wide, config.code_size / kNumPositions, 3, 1, 1}},
          .code_size = config.code_size,
          .target_size = target_length(config.target)};
}

int code_size(const Encoder& encoder) {
  return encoder.convolutions.back().plan.num_outputs * kNumPositions;
}

}  // namespace samewhere::train
