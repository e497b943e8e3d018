#include <optional>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/stage_thread.hpp>
#include <samewhere/twin/frame_workers.hpp>
#include <samewhere/twin/studio.hpp>
#include <samewhere/twin/twin.hpp>

namespace samewhere::twin {
namespace {

class TwinSource : public core::Source {
 public:
  TwinSource(std::shared_ptr<const Walkthrough> walk, const Config& config)
      : walk_(std::move(walk)), config_(config) {
    core::require(walk_ != nullptr, "a source of frames has a walk");
  }

  core::SourceInfo info() const override {
    return {.name = walk_->name(),
            .format = "twin building",
            .num_frames = walk_->num_frames(),
            .has_depth = walk_->spec().sensors == Sensors::kRgbd,
            .is_calibrated = true,
            .frame_rate_hz = kFrameRate_hz};
  }

  std::optional<core::Frame> next() override {
    if (!workers_) {
      studio_.emplace(*walk_, config_);
      const int num_workers =
          config_.num_workers > 0 ? config_.num_workers : core::num_hardware_threads();
      workers_.emplace(walk_->num_frames(), num_workers,
                       [this](int index) { return studio_->frame(index); });
    }
    return workers_->next();
  }

  core::Truth truth() const override {
    return core_truth(walk_->walk().poses, walk_->truth());
  }

 private:
  std::shared_ptr<const Walkthrough> walk_;
  Config config_;
  std::optional<Studio> studio_;
  std::optional<FrameWorkers<core::Frame>> workers_;  // last: they end before what they use
};

}  // namespace

std::unique_ptr<core::Source> open_twin(const std::string& spec, const Config& config) {
  return open_twin(std::make_shared<const Walkthrough>(parse_spec(spec), config), config);
}

std::unique_ptr<core::Source> open_twin(std::shared_ptr<const Walkthrough> walk,
                                        const Config& config) {
  return std::make_unique<TwinSource>(std::move(walk), config);
}

}  // namespace samewhere::twin
