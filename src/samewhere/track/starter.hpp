#pragma once

#include <optional>
#include <string>

#include <samewhere/track/start.hpp>

namespace samewhere::track {

// An earlier view and what it says together with the one just offered.
struct StartedPair {
  features::View first;
  std::vector<features::View> between;  // in the order of time; they have no pose yet
  Start start;
};

// Waits for two views that start a map: keeps one and tries it against those that follow, until so
// few features match, or so many frames have passed, that the latest takes its place.
class Starter {
 public:
  explicit Starter(const StartSettings& settings) : settings_(settings) {}

  // Views ascend in time. Nothing: not yet.
  std::optional<StartedPair> offer(const features::View& view);
  // The view that was kept starts nothing any more.
  void forget();
  // Why the last two views that were tried are no start; empty if none were.
  const std::string& last_refusal() const { return last_refusal_; }

 private:
  StartSettings settings_;
  std::optional<features::View> first_;
  std::vector<features::View> between_;
  std::string last_refusal_;
};

}  // namespace samewhere::track
