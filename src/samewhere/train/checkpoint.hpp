#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <samewhere/train/network_plan.hpp>

namespace samewhere::train {

// How one pass over the examples went. What an error is, the learner says.
struct EpochFigures {
  int epoch = 0;  // from 1
  double training_error = 0.0;
  double validation_error = 0.0;
};

// All that a training needs to go on as if it had never stopped. Random numbers are drawn by seed,
// epoch and image, so that `history` stands for their state too.
struct Checkpoint {
  std::string settings;  // YAML; a training with others is another training
  std::string network;   // its layers, for a person; with others the rest would not fit
  std::string images_sha256;
  std::vector<std::string> commits;  // of the programs that trained, one after the other
  std::vector<EpochFigures> history;
  std::string learner;                 // state() of what learns after the last epoch
  std::vector<float> best_parameters;  // of the network with the least validation error
  std::vector<float> best_codes;       // what it made of a few inputs, one after the other
};

// Writes the whole file or nothing. Throws InputError: no space, no permission.
void write_checkpoint(const std::filesystem::path& path, const Checkpoint& checkpoint);
// Throws InputError if the file is no checkpoint or damaged.
Checkpoint read_checkpoint(const std::filesystem::path& path);

// Whether there is something of that name. Throws InputError where the system cannot say: a name
// too long, a folder that may not be looked into.
bool is_there(const std::filesystem::path& path);

// All weights and biases of trained convolutions in a row; and back into those of the same plans.
std::vector<float> parameters_of(std::span<const Convolution> convolutions);
std::vector<Convolution> convolutions_with(std::span<const ConvolutionPlan> plans,
                                           std::span<const float> parameters);

}  // namespace samewhere::train
