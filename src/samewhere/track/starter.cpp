#include <samewhere/track/starter.hpp>

namespace samewhere::track {

std::optional<StartedPair> Starter::offer(const features::View& view) {
  if (first_) {
    auto start = try_start(*first_, view, settings_);
    if (start) {
      StartedPair started{*first_, std::move(between_), *std::move(start)};
      forget();
      return started;
    }
    last_refusal_ = start.error().reason;
    const bool is_too_late =
        static_cast<int>(between_.size()) >= settings_.start.max_waiting_frames;
    if (start.error().refusal != StartRefusal::kFewMatches && !is_too_late) {
      between_.push_back(view);
      return std::nullopt;
    }
  }
  first_ = view;
  between_.clear();
  return std::nullopt;
}

void Starter::forget() {
  first_.reset();
  between_.clear();
}

}  // namespace samewhere::track
