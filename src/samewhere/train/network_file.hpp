#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <samewhere/network/inference.hpp>
#include <samewhere/train/card.hpp>
#include <samewhere/train/trainer.hpp>

namespace samewhere::train {

// What a person asked for.
struct Job {
  std::vector<std::string> images;    // sources to learn from
  std::vector<std::string> validate;  // sources to validate with; none: blocks of the others
  std::filesystem::path out;          // *.onnx
  Config config;
  std::string command;  // as it was typed, for the card
  std::string version;  // of the program
};

// What the finished network does on the validation views.
struct Quality {
  EpochFigures best;
  double recognition = 0.0;
  double recognition_of_hog = 0.0;
};

// Writes the best encoder of a training as an ONNX file with its card (JSON) and removes the
// checkpoint. Before, the very bytes that are written are run by network::make_inference on
// Trainer::checked_inputs(): an export_error() above 1e-5 throws ContractError. Throws InputError
// if the network's weights are not finite or all its codes are zero, and if a file cannot be
// written. After an error there is no network, and the checkpoint is still there.
Quality write_network(const Job& job, const ImageSet& images, Trainer& trainer);

// The largest difference between what the trained network made of some inputs (one code after the
// other) and what the exported one makes of them, in shares of the largest number of the code; not
// finite if a number of either is not.
double export_error(network::Inference& exported, std::span<const cv::Mat> inputs,
                    std::span<const float> trained_codes);

}  // namespace samewhere::train
