#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <samewhere/train/card.hpp>
#include <samewhere/train/head_training.hpp>

namespace samewhere::train {

// What a person asked for.
struct HeadJob {
  HeadKind kind = HeadKind::kGem;
  std::vector<std::string> images;    // sources to learn from
  std::vector<std::string> validate;  // rendered walks
  std::filesystem::path out;          // *.onnx
  std::filesystem::path cache;        // folder of feature maps; empty: none is kept
  std::string trunks;                 // folder of the published networks; empty: as describe.trunks
  HeadConfig config;
  std::string command;  // as it was typed, for the card
  std::string version;  // of the program
  std::string commit;
};

// The trunk of a kind.
network::TrunkSpec trunk_of(HeadKind kind);

// Writes the head with its card, which describe::make_network_describer reads. Before, the very
// bytes are run by network::make_inference on some views: a difference from the trained head above
// 1e-3 of the largest number throws ContractError. Throws InputError if a weight is not finite or a
// file cannot be written.
void write_head(const HeadJob& job, const TrainedHead& trained,
                const std::vector<HeadSource>& sources, const std::vector<HeadSource>& validation,
                const network::Trunk& trunk);

}  // namespace samewhere::train
