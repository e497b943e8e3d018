#pragma once

#include <deque>
#include <exception>
#include <functional>
#include <optional>
#include <utility>

#include <samewhere/core/channel.hpp>
#include <samewhere/core/errors.hpp>
#include <samewhere/core/stage_thread.hpp>

namespace samewhere::twin {

// Makes frames 0, 1, 2, ... on several threads and gives them out in order: worker i makes those
// that are i modulo the number of workers, at most two ahead of what was asked for. What
// make(index) returns must depend on the index alone; then the frames do not depend on the workers.
// May be destroyed at any time: frames in the making are finished first.
template <class Frame>
class FrameWorkers {
 public:
  // `make` is called by all workers at once. Throws InputError if the system refuses a thread.
  FrameWorkers(int num_frames, int num_workers, std::function<Frame(int)> make)
      : num_frames_(num_frames), make_(std::move(make)) {
    core::require(num_workers > 0, "frames are made by at least one worker");
    constexpr std::size_t kAhead = 1;  // ready, beside the one in the making
    for (int i = 0; i < num_workers; ++i) channels_.emplace_back(kAhead);
    try {
      for (int i = 0; i < num_workers; ++i) workers_.emplace_back([this, i] { run(i); });
    } catch (...) {  // those that run are waited for, and must not wait for us
      close_all();
      throw;
    }
  }
  FrameWorkers(const FrameWorkers&) = delete;
  FrameWorkers& operator=(const FrameWorkers&) = delete;
  ~FrameWorkers() { close_all(); }

  // The next frame, or nothing at the end. Throws what make() threw for it; no frames come after
  // that.
  std::optional<Frame> next() {
    if (next_ == num_frames_) return std::nullopt;
    auto made = channels_[static_cast<std::size_t>(next_) % channels_.size()].receive();
    core::require(made.has_value(), "a worker answers for each of its frames");
    if (made->error) {
      next_ = num_frames_;
      std::rethrow_exception(made->error);
    }
    ++next_;
    return std::move(made->frame);
  }

 private:
  struct Made {
    std::optional<Frame> frame;
    std::exception_ptr error;
  };

  void close_all() {
    for (auto& channel : channels_) channel.close();
  }

  Made made(int index) const {
    try {
      return {.frame = make_(index), .error = nullptr};
    } catch (...) {
      return {.frame = std::nullopt, .error = std::current_exception()};
    }
  }

  void run(int first) {
    const int num_workers = static_cast<int>(channels_.size());
    for (int index = first; index < num_frames_; index += num_workers) {
      Made result = made(index);
      const bool has_failed = result.error != nullptr;
      if (!channels_[static_cast<std::size_t>(first)].send(std::move(result)) || has_failed) return;
    }
  }

  int num_frames_;
  int next_ = 0;
  std::function<Frame(int)> make_;
  std::deque<core::Channel<Made>> channels_;
  std::deque<core::WorkerThread> workers_;  // last: they end before what they use
};

}  // namespace samewhere::twin
