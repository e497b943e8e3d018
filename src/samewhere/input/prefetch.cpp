#include <utility>

#include <samewhere/core/channel.hpp>
#include <samewhere/core/errors.hpp>
#include <samewhere/core/stage_thread.hpp>
#include <samewhere/input/prefetch.hpp>

namespace samewhere::input {
namespace {

class PrefetchedSource : public core::Source {
 public:
  explicit PrefetchedSource(std::unique_ptr<core::Source> source)
      : source_(std::move(source)),
        frames_(1),
        reader_(frames_, [this] { return source_->next(); }) {}
  PrefetchedSource(const PrefetchedSource&) = delete;
  PrefetchedSource& operator=(const PrefetchedSource&) = delete;
  ~PrefetchedSource() override = default;

  core::SourceInfo info() const override { return source_->info(); }
  core::Truth truth() const override { return source_->truth(); }
  core::Trajectory true_trajectory() const override { return source_->true_trajectory(); }

  std::optional<core::Frame> next() override {
    std::optional<core::Frame> frame = frames_.receive();
    if (!frame) reader_.join();  // the end, or what the reader threw
    return frame;
  }

 private:
  std::unique_ptr<core::Source> source_;
  core::Channel<core::Frame> frames_;
  core::SourceThread<core::Frame> reader_;  // last: starts when all above is ready, ends before it
};

}  // namespace

std::unique_ptr<core::Source> prefetched(std::unique_ptr<core::Source> source) {
  core::require(source != nullptr, "there is a source to read ahead");
  return std::make_unique<PrefetchedSource>(std::move(source));
}

}  // namespace samewhere::input
