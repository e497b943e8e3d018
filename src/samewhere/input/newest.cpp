#include <utility>

#include <samewhere/core/channel.hpp>
#include <samewhere/core/errors.hpp>
#include <samewhere/core/stage_thread.hpp>
#include <samewhere/input/newest.hpp>

namespace samewhere::input {
namespace {

// Tells both sides that there is nothing more to come, or nobody to take it.
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
  explicit NewestSource(std::unique_ptr<core::Source> source)
      : source_(std::move(source)), frames_(1), reader_([this] { read(); }), closing_(frames_) {}
  NewestSource(const NewestSource&) = delete;
  NewestSource& operator=(const NewestSource&) = delete;
  ~NewestSource() override = default;

  core::SourceInfo info() const override { return source_->info(); }
  core::Truth truth() const override { return source_->truth(); }
  core::Trajectory true_trajectory() const override { return source_->true_trajectory(); }

  std::optional<core::Frame> next() override {
    std::optional<core::Frame> frame = frames_.receive();
    if (!frame) {
      reader_.join();  // the end, or what the source threw
      return std::nullopt;
    }
    const std::uint64_t position = frame->id.index();
    frame->num_dropped_before = static_cast<int>(position - num_come_);
    num_come_ = position + 1;
    frame->id = core::FrameId(num_given_++);
    return frame;
  }

 private:
  void read() {
    const Closing closing(frames_);
    while (std::optional<core::Frame> frame = source_->next()) {
      if (!frames_.send_newest(std::move(*frame))) return;
    }
  }

  std::unique_ptr<core::Source> source_;
  core::Channel<core::Frame> frames_;
  std::uint64_t num_come_ = 0;  // given or dropped
  std::uint64_t num_given_ = 0;
  core::WorkerThread reader_;  // starts when all above is ready
  Closing closing_;            // last: ends the reader, which its own destructor waits for
};

}  // namespace

std::unique_ptr<core::Source> newest(std::unique_ptr<core::Source> source) {
  core::require(source != nullptr, "there is a live source to read");
  return std::make_unique<NewestSource>(std::move(source));
}

}  // namespace samewhere::input
