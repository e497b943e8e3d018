#pragma once

#include <functional>

#include <samewhere/core/channel.hpp>

namespace samewhere::view {

// How fast a recording is processed, as the pages ask for it.
struct PaceWish {
  bool is_paused = false;
  int num_steps = 0;   // frames that a pause lets through
  double speed = 0.0;  // of the recording's own; 0: as fast as possible
};

// Lets a run wait between its frames.
class Pace {
 public:
  // From any thread.
  void set(const PaceWish& wish) { wish_.set(wish); }
  void step() {
    wish_.with([](PaceWish& wish) { return ++wish.num_steps; });
  }
  PaceWish get() const { return wish_.get(); }

  // In the run's thread, after the frame with this stamp: returns when the next may come, or when
  // `is_over` says that waiting has no sense any more.
  void wait(double stamp_s, const std::function<bool()>& is_over);

 private:
  bool is_due(double stamp_s);

  core::Guarded<PaceWish> wish_;
  core::Channel<int> never_{1};
  double last_stamp_s_ = 0.0;
  double last_s_ = -1.0;  // on the clock, when the frame before was let through
};

}  // namespace samewhere::view
