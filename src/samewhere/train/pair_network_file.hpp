#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <samewhere/train/card.hpp>
#include <samewhere/train/pair_trainer.hpp>

namespace samewhere::train {

// What a person asked for.
struct PairJob {
  std::vector<std::string> sources;   // to learn from
  std::vector<std::string> validate;  // to validate with
  std::filesystem::path out;          // *.onnx
  std::filesystem::path prepared;     // where the pairs are kept; empty: nowhere
  PairConfig config;
  std::string command;  // as it was typed, for the card
  std::string version;  // of the program
};

// The pairs of a job: read from where they are kept, else made and kept there. Throws as
// read_pairs(), load_pairs() and write_pairs() do.
PairSet prepared_pairs(const PairJob& job);

// What the finished network does on the validation pairs.
struct PairQuality {
  EpochFigures best;
  evaluate::Separation separation;
};

// Writes the best network of a training as an ONNX file with its card (JSON) and removes the
// checkpoint. Before, the very bytes that are written are run by network::make_inference on
// PairTrainer::checked_planes(): an answer more than 1e-5 away throws ContractError. Throws
// InputError if the network's answers are not finite or all the same, and if a file cannot be
// written.
PairQuality write_pair_network(const PairJob& job, const PairSet& set, const PairTrainer& trainer);

}  // namespace samewhere::train
