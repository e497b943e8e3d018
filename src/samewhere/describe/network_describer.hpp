#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <samewhere/describe/describer.hpp>
#include <samewhere/network/card.hpp>

namespace samewhere::describe {

// Describes a view in colour by networks that were trained elsewhere or on their features:
// the feature map of a trunk, the output of a network, or that of a head fed with a trunk's map.
// The vector has length 1; a view of one level is all zero. describe() throws InputError naming the
// file if a number is not finite.

// `word`: "squeezenet": the mean over all positions of the trunk's map (512 numbers). "darknet",
// "gem" and "netvlad": the head models/WORD.onnx, fed as its card says. Throws InputError as
// network::find_trunk, make_trunk, find_network, read_network, read_input_card and make_inference
// do.
std::unique_ptr<Describer> make_baseline(const std::string& word, const Config& config);

// An ONNX network whose card says how it is fed. Throws as above, and if trunk and head do not fit
// or the output is no vector of at least 2 numbers.
std::unique_ptr<Describer> make_network_describer(const network::NetworkFile& network,
                                                  const Config& config);

// Throws InputError naming file, number and frame unless all numbers are finite.
void require_finite(const std::vector<float>& code, const std::string& file, core::FrameId frame);

}  // namespace samewhere::describe
