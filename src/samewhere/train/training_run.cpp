#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/random.hpp>
#include <samewhere/train/training_run.hpp>

namespace samewhere::train {
namespace {

using core::InputError;

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t start = 0; start < text.size();) {
    const std::size_t end = std::min(text.find('\n', start), text.size());
    lines.push_back(text.substr(start, end - start));
    start = end + 1;
  }
  return lines;
}

// One setting a line.
void check_settings(const std::filesystem::path& checkpoint, const std::string& found,
                    const std::string& expected) {
  const std::vector<std::string> theirs = lines_of(found);
  const std::vector<std::string> ours = lines_of(expected);
  for (std::size_t i = 0; i < std::max(theirs.size(), ours.size()); ++i) {
    const std::string their = i < theirs.size() ? theirs[i] : "nothing";
    const std::string our = i < ours.size() ? ours[i] : "nothing";
    if (their == our) continue;
    throw InputError(fmt::format(
        "{}: was made with {}, this command says {}; give the same settings, or remove it to begin "
        "anew",
        checkpoint.string(), their, our));
  }
}

}  // namespace

std::vector<std::vector<int>> cut(const std::vector<int>& order, int batch) {
  std::vector<std::vector<int>> batches;
  for (std::size_t start = 0; start < order.size(); start += static_cast<std::size_t>(batch)) {
    const std::size_t end = std::min(order.size(), start + static_cast<std::size_t>(batch));
    batches.emplace_back(order.begin() + static_cast<std::ptrdiff_t>(start),
                         order.begin() + static_cast<std::ptrdiff_t>(end));
  }
  return batches;
}

TrainingRun::TrainingRun(const Schedule& schedule, Checkpoint fresh,
                         std::filesystem::path checkpoint, const std::string& option)
    : schedule_(schedule), checkpoint_path_(std::move(checkpoint)), state_(std::move(fresh)) {
  if (is_there(checkpoint_path_)) resume(read_checkpoint(checkpoint_path_), option);
}

void TrainingRun::resume(Checkpoint found, const std::string& option) {
  check_settings(checkpoint_path_, found.settings, state_.settings);
  if (found.network != state_.network) {
    throw InputError(fmt::format(
        "{}: was made by commit {} with another network ({}), this program has {}; go on with that "
        "one, or remove it to start from the beginning",
        checkpoint_path_.string(), fmt::join(found.commits, ", "), found.network, state_.network));
  }
  if (found.images_sha256 != state_.images_sha256) {
    throw InputError(
        fmt::format("{}: was made with other images; give the same {}, or remove it to start from "
                    "the beginning",
                    checkpoint_path_.string(), option));
  }
  const std::string commit = state_.commits.back();
  state_ = std::move(found);
  if (state_.commits.back() != commit) state_.commits.push_back(commit);
}

bool TrainingRun::is_done() const {
  const int num_done = static_cast<int>(history().size());
  if (num_done == 0) return false;
  return num_done >= schedule_.epochs || num_done - best_epoch().epoch >= schedule_.patience;
}

EpochFigures TrainingRun::best_epoch() const {
  core::require(!history().empty(), "the best epoch is one of those done");
  return *std::min_element(history().begin(), history().end(),
                           [](const EpochFigures& a, const EpochFigures& b) {
                             return a.validation_error < b.validation_error;
                           });
}

double TrainingRun::learning_rate() const {
  const double done = static_cast<double>(epoch() - 1) / schedule_.epochs;
  return schedule_.learning_rate * 0.5 * (1.0 + std::cos(std::numbers::pi * done));
}

std::uint64_t TrainingRun::epoch_seed() const {
  return core::seed_of(schedule_.seed, "epoch", static_cast<std::uint64_t>(epoch()));
}

// Fisher and Yates.
std::vector<std::vector<int>> TrainingRun::batches(const std::vector<int>& indices) const {
  std::vector<int> order = indices;
  core::Random random(core::seed_of(schedule_.seed, "order", static_cast<std::uint64_t>(epoch())));
  for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random.index(i)]);
  std::vector<std::vector<int>> batches = cut(order, schedule_.batch);
  if (batches.size() > 1 && batches.back().size() == 1) batches.pop_back();
  return batches;
}

void TrainingRun::require_finite(double error) const {
  if (std::isfinite(error)) return;
  throw InputError(fmt::format(
      "learning_rate = {}: the loss is no longer finite in epoch {}, expected a smaller one",
      schedule_.learning_rate, epoch()));
}

void TrainingRun::finish_epoch(const EpochFigures& figures, std::string learner,
                               const std::function<Kept()>& kept) {
  state_.history.push_back(figures);
  state_.learner = std::move(learner);
  if (best_epoch().epoch == figures.epoch) {
    Kept best = kept();
    state_.best_parameters = std::move(best.parameters);
    state_.best_codes = std::move(best.codes);
  }
  write_checkpoint(checkpoint_path_, state_);
}

}  // namespace samewhere::train
