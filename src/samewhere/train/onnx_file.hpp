#pragma once

#include <string>

#include <samewhere/train/network_plan.hpp>

namespace samewhere::train {

// The encoder as an ONNX model (operator set 11): input `image`, 1 x 1 x rows x columns, 32-bit
// float in [0, 1] (encoder_input), output `code`, 1 x length. `description` is for people.
std::string onnx_bytes(const Encoder& encoder, const std::string& description);

}  // namespace samewhere::train
