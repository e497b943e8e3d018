#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <samewhere/train/trainer.hpp>

namespace samewhere::train {

// What a person asked for.
struct Job {
  std::vector<std::string> images;  // sources
  std::filesystem::path out;        // *.onnx
  Config config;
  std::string command;  // as it was typed, for the card
  std::string version;  // of the program, and the commit it was built from
  std::string commit;
};

// Files beside the network: what the training goes on from, and what tells how it came about.
std::filesystem::path checkpoint_of(const std::filesystem::path& network);
std::filesystem::path card_of(const std::filesystem::path& network);

// What the finished network does on the validation views.
struct Quality {
  EpochFigures best;
  double recognition = 0.0;
  double recognition_of_hog = 0.0;
};

// Writes the best encoder of a training as an ONNX file with its card (JSON) and removes the
// checkpoint. Before, the encoder of the last epoch is exported and run by OpenCV on validation
// views: a code further than 1e-5 of its largest number from the trained one's throws
// ContractError, and nothing is written. Throws InputError if a file cannot be written.
Quality write_network(const Job& job, const ImageSet& images, Trainer& trainer);

// The largest difference between the codes of trained and exported network on some of the views, in
// shares of the largest number of the code.
double export_error(Autoencoder& autoencoder, const ImageSet& images, const Config& config);

}  // namespace samewhere::train
