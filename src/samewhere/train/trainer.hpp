#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <samewhere/train/autoencoder.hpp>
#include <samewhere/train/config.hpp>
#include <samewhere/train/image_set.hpp>
#include <samewhere/train/training_run.hpp>

namespace samewhere::train {

// Trains one autoencoder, epoch by epoch, until `epochs` are done or `patience` of them have not
// lowered the validation error. After each epoch all is written to a checkpoint.
class Trainer {
 public:
  // Goes on from the checkpoint if there is one. Throws InputError if it belongs to other settings
  // (naming the first), another network or other images. `commit` is that of the running program.
  // `images` must outlive the trainer.
  Trainer(const Config& config, const ImageSet& images, std::filesystem::path checkpoint,
          const std::string& commit);

  const NetworkPlan& plan() const { return plan_; }
  const Split& split() const { return split_; }
  const std::vector<EpochFigures>& history() const { return run_.history(); }
  // Of the programs that had a part in it, each once where it took over. Two may train differently.
  const std::vector<std::string>& commits() const { return run_.state().commits; }
  bool is_done() const { return run_.is_done(); }
  // As the last epoch left it.
  Autoencoder& autoencoder() { return autoencoder_; }

  // One pass over the images, told to `on_progress` (images done, images in all). Nothing if
  // core::is_interrupted() ended it after a batch: what it learnt is lost, the epochs before are in
  // the checkpoint. Throws InputError if the checkpoint cannot be written, or if the loss, of
  // training or of validation, is no longer finite: the checkpoint stays that of the epoch before.
  std::optional<EpochFigures> run_epoch(const std::function<void(int, int)>& on_progress);

  // The epoch with the least validation error so far, and its encoder. At least one epoch is done.
  EpochFigures best_epoch() const { return run_.best_epoch(); }
  Encoder best_encoder() const;

  // Up to 16 validation views as the encoder sees them, and what the network itself, not its
  // export, made of them when it was best: one code after the other.
  std::vector<cv::Mat> checked_inputs() const;
  std::span<const float> best_codes() const { return run_.state().best_codes; }

 private:
  std::optional<double> learn(const std::function<void(int, int)>& on_progress);
  double validation_error();
  std::vector<float> checked_codes();

  Config config_;
  NetworkPlan plan_;
  Split split_;
  ExampleMaker examples_;
  TrainingRun run_;
  Autoencoder autoencoder_;
};

}  // namespace samewhere::train
