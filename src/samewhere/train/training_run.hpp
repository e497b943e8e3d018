#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <samewhere/train/checkpoint.hpp>

namespace samewhere::train {

// How long and how fast is learnt.
struct Schedule {
  int epochs = 0;
  int batch = 0;
  int patience = 0;
  double learning_rate = 0.0;
  std::uint64_t seed = 0;
};

template <class Settings>
Schedule schedule_of(const Settings& settings) {
  return {.epochs = settings.epochs,
          .batch = settings.batch,
          .patience = settings.patience,
          .learning_rate = settings.learning_rate,
          .seed = static_cast<std::uint64_t>(settings.seed)};
}

// Up to `batch` of them each.
std::vector<std::vector<int>> cut(const std::vector<int>& order, int batch);

// The epochs of one training, whatever it is that learns: their order, their learning rates, which
// was best, and the checkpoint from which a stopped training goes on.
class TrainingRun {
 public:
  // `fresh` names settings, network, data and the commit of the running program. If there is a
  // checkpoint, what it knows takes its place. Throws InputError if that belongs to other settings
  // (naming the first), another network or other data (which `option` names).
  TrainingRun(const Schedule& schedule, Checkpoint fresh, std::filesystem::path checkpoint,
              const std::string& option);

  const Checkpoint& state() const { return state_; }
  const std::vector<EpochFigures>& history() const { return state_.history; }
  bool is_done() const;
  // The one with the least validation error; at least one is done.
  EpochFigures best_epoch() const;

  // Of the epoch that comes next, from 1; the others are of it.
  int epoch() const { return static_cast<int>(history().size()) + 1; }
  // Falls along half a cosine.
  double learning_rate() const;
  std::uint64_t epoch_seed() const;
  // All of `indices`, in a new order each time; a last batch of one is left out, because a
  // normalisation over one example says nothing.
  std::vector<std::vector<int>> batches(const std::vector<int>& indices) const;
  // Throws InputError naming the learning rate.
  void require_finite(double error) const;

  // What is kept of the best epoch: parameters, and what the network made of a few inputs.
  struct Kept {
    std::vector<float> parameters;
    std::vector<float> codes;
  };
  // Ends the epoch and writes the checkpoint. `learner` is the state of what learns; `kept` is
  // asked if no epoch was better.
  void finish_epoch(const EpochFigures& figures, std::string learner,
                    const std::function<Kept()>& kept);

 private:
  void resume(Checkpoint found, const std::string& option);

  Schedule schedule_;
  std::filesystem::path checkpoint_path_;
  Checkpoint state_;
};

}  // namespace samewhere::train
