#include <algorithm>
#include <chrono>
#include <optional>
#include <utility>

#include <samewhere/core/channel.hpp>
#include <samewhere/core/errors.hpp>
#include <samewhere/core/interrupt.hpp>
#include <samewhere/core/stage_thread.hpp>
#include <samewhere/input/newest.hpp>

namespace samewhere::input {
namespace {

// Tells both sides that there is nothing more to come, or that no frame is taken any more.
class Closing {
 public:
  explicit Closing(core::Channel<core::Frame>& frames) : frames_(frames) {}
  Closing(const Closing&) = delete;
  Closing& operator=(const Closing&) = delete;
  ~Closing() { frames_.close(); }

 private:
  core::Channel<core::Frame>& frames_;
};

class NewestSource : public core::Source {
 public:
  // Reads when start() was called, or next(). An empty `wait` goes by the clock.
  NewestSource(std::unique_ptr<core::Source> source, WaitUntil wait)
      : source_(std::move(source)), wait_(std::move(wait)), frames_(1), closing_(frames_) {
    if (!wait_) wait_ = [this](double since_first_s) { return wait_by_clock(since_first_s); };
  }
  NewestSource(const NewestSource&) = delete;
  NewestSource& operator=(const NewestSource&) = delete;
  ~NewestSource() override = default;

  core::SourceInfo info() const override {
    core::SourceInfo info = source_->info();
    info.is_live = true;
    return info;
  }
  core::Truth truth() const override { return source_->truth(); }
  core::Trajectory true_trajectory() const override { return source_->true_trajectory(); }

  void start() {
    if (!reader_) reader_.emplace([this] { read(); });
  }

  std::optional<core::Frame> next() override {
    start();
    std::optional<core::Frame> frame = frames_.receive();
    if (!frame) {
      reader_->join();  // the end, or what the source threw
      return std::nullopt;
    }
    const std::uint64_t position = frame->id.index();
    frame->num_dropped_before = static_cast<int>(position - num_come_);
    num_come_ = position + 1;
    frame->id = core::FrameId(num_given_++);
    return frame;
  }

 private:
  using Clock = std::chrono::steady_clock;

  void read() {
    const Closing closing(frames_);
    std::optional<double> first_stamp_s;
    while (std::optional<core::Frame> frame = source_->next()) {
      if (!first_stamp_s) first_stamp_s = frame->stamp_s;
      if (!wait_(frame->stamp_s - *first_stamp_s)) return;
      if (!frames_.send_newest(std::move(*frame))) return;
    }
  }

  // Polls: a signal wakes no waiting thread.
  bool wait_by_clock(double since_first_s) {
    constexpr double kLook_s = 0.1;
    if (!start_) start_ = Clock::now();
    for (;;) {
      const std::chrono::duration<double> passed = Clock::now() - *start_;
      const double left_s = since_first_s - passed.count();
      if (left_s <= 0.0) return true;
      if (core::is_interrupted() || !frames_.is_open_for(std::min(left_s, kLook_s))) return false;
    }
  }

  std::unique_ptr<core::Source> source_;
  WaitUntil wait_;
  std::optional<Clock::time_point> start_;  // the reader's
  core::Channel<core::Frame> frames_;
  std::uint64_t num_come_ = 0;  // given or dropped
  std::uint64_t num_given_ = 0;
  std::optional<core::WorkerThread> reader_;
  Closing closing_;  // last: ends the reader, which its own destructor waits for
};

}  // namespace

std::unique_ptr<core::Source> newest(std::unique_ptr<core::Source> source) {
  core::require(source != nullptr, "there is a source to read");
  auto live = std::make_unique<NewestSource>(std::move(source), [](double) { return true; });
  live->start();
  return live;
}

std::unique_ptr<core::Source> played(std::unique_ptr<core::Source> source, WaitUntil wait) {
  core::require(source != nullptr, "there is a source to play");
  return std::make_unique<NewestSource>(std::move(source), std::move(wait));
}

}  // namespace samewhere::input
