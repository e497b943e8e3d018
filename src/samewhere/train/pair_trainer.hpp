#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <samewhere/evaluate/separation.hpp>
#include <samewhere/train/pair_classifier.hpp>
#include <samewhere/train/pair_examples.hpp>
#include <samewhere/train/training_run.hpp>

namespace samewhere::train {

// Trains one network that judges pairs, epoch by epoch, until `epochs` are done or `patience` of
// them have not lowered the validation error. After each epoch all is written to a checkpoint.
class PairTrainer {
 public:
  // Goes on from the checkpoint if there is one. Throws InputError if it belongs to other settings
  // (naming the first), another network or other pairs. `commit` is that of the running program.
  // `set` must outlive the trainer.
  PairTrainer(const PairConfig& config, const PairSet& set, std::filesystem::path checkpoint,
              const std::string& commit);

  const std::vector<ConvolutionPlan>& plan() const { return plan_; }
  const std::vector<EpochFigures>& history() const { return run_.history(); }
  const std::vector<std::string>& commits() const { return run_.state().commits; }
  bool is_done() const { return run_.is_done(); }
  int num_training() const { return static_cast<int>(training_.size()); }
  int num_validation() const { return static_cast<int>(validation_.size()); }

  // One pass over the pairs, told to `on_progress` (pairs done, pairs in all). Nothing if
  // core::is_interrupted() ended it: what it learnt is lost, the epochs before are in the
  // checkpoint. Throws InputError if the checkpoint cannot be written, or if the loss is no longer
  // finite.
  std::optional<EpochFigures> run_epoch(const std::function<void(int, int)>& on_progress);

  EpochFigures best_epoch() const { return run_.best_epoch(); }
  PairNetwork best_network() const;
  // As the last epoch left it.
  PairClassifier& classifier() { return classifier_; }

  // Up to 16 validation pairs as the network sees them, and what the network itself, not its
  // export, made of each when it was best.
  std::vector<cv::Mat> checked_planes() const;
  std::span<const float> best_answers() const { return run_.state().best_codes; }

  // Of all validation pairs, the true ones then the others: what `judge` makes of their planes.
  evaluate::Separation separation(const std::function<double(const cv::Mat&)>& judge) const;

 private:
  std::optional<double> learn(const std::function<void(int, int)>& on_progress);
  double validation_error();

  PairConfig config_;
  const PairSet& set_;
  std::vector<ConvolutionPlan> plan_;
  std::vector<int> training_;
  std::vector<int> validation_;
  PairExampleMaker examples_;
  TrainingRun run_;
  PairClassifier classifier_;
};

}  // namespace samewhere::train
