#pragma once

#include <string>

#include <samewhere/train/head_network.hpp>

namespace samewhere::train {

// The head as an ONNX model (operator set 13): input `features`, 1 x C x H x W, output `code`, 1 x
// code_size.
std::string head_onnx_bytes(const HeadWeights& head);

}  // namespace samewhere::train
