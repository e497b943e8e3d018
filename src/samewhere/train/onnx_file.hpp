#pragma once

#include <string>

#include <samewhere/train/network_plan.hpp>
#include <samewhere/train/pair_plan.hpp>

namespace samewhere::train {

// The encoder as an ONNX model (operator set 11): input `image`, 1 x 1 x rows x columns, 32-bit
// float in [0, 1] (encoder_input), output `code`, 1 x length. `description` is for people.
std::string onnx_bytes(const Encoder& encoder, const std::string& description);

// The network that judges pairs: input `planes`, 1 x 1 x 896 x 128, as verify::PairView has them;
// output `same`, 1 x 1, how probable it is that both views show one place.
std::string onnx_bytes(const PairNetwork& network, const std::string& description);

}  // namespace samewhere::train
