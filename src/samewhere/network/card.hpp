#pragma once

#include <filesystem>
#include <optional>

#include <samewhere/network/network_file.hpp>
#include <samewhere/network/trunk.hpp>

namespace samewhere::network {

// What a network is fed: a picture, or the feature map that a trunk makes of one.
struct InputCard {
  PictureFormat picture;           // without a trunk
  std::optional<TrunkSpec> trunk;  // of a head
};

// FILE.json beside FILE.onnx.
std::filesystem::path card_path(std::filesystem::path network);

// "input" of that card. Of a network 1x3xHxW it has
//   {"colour": "rgb" or "bgr", "mean": N or [N, N, N], "scale": the same}
// and the network gets (x - mean) * scale, x in [0, 255]; absent: mean 0, scale 1. Of a head it has
//   {"trunk": "mobilenet_v2.onnx", "layer": NAME, "rows": N, "columns": N} and these three.
// Throws InputError naming the card and the key if it is not there or says something else.
InputCard read_input_card(const NetworkFile& network);

}  // namespace samewhere::network
