#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <samewhere/train/checkpoint.hpp>

namespace samewhere::train {

using OrderedJson = nlohmann::ordered_json;

// Files beside the network: what the training goes on from, and what tells how it came about.
std::filesystem::path checkpoint_of(const std::filesystem::path& network);
std::filesystem::path card_of(const std::filesystem::path& network);

// Throws InputError if the network or its card is there already, unless the checkpoint of a
// training is, too, or if the system cannot say.
void require_free(const std::filesystem::path& network);

// "key: value" lines as an object.
OrderedJson settings_as_json(const std::string& yaml);
OrderedJson epochs_as_json(const std::vector<EpochFigures>& history);
// "convolution 3 x 3, 16 to 32 channels, stride 2, padding 1".
std::string layer_text(const ConvolutionPlan& plan);

// Writes a network and its card, and removes the checkpoint. Throws InputError if a file cannot be
// written.
void write_with_card(const std::filesystem::path& network, const std::string& bytes,
                     const OrderedJson& card);

}  // namespace samewhere::train
