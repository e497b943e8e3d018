#include <optional>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <samewhere/core/stage_thread.hpp>
#include <samewhere/twin/frame_workers.hpp>
#include <samewhere/twin/picture_cache.hpp>
#include <samewhere/twin/studio.hpp>
#include <samewhere/twin/twin.hpp>

namespace samewhere::twin {
namespace {

// To be raised with every change of what the pictures show: kept ones of another version are not
// taken.
constexpr int kPicturesVersion = 6;

PictureCache cache_for(const Walkthrough& walk, const Config& config) {
  const std::string key =
      fmt::format("{} pictures {}", canonical_text(walk.spec()), kPicturesVersion);
  // ideal depth is not in the units that the cache keeps
  return config.ideal_depth ? PictureCache(key, std::nullopt) : PictureCache(key);
}

class TwinSource : public core::Source {
 public:
  TwinSource(std::shared_ptr<const Walkthrough> walk, const Config& config)
      : walk_(std::move(walk)), config_(config), cache_(cache_for(*walk_, config)) {}

  core::SourceInfo info() const override {
    return {.name = walk_->name(),
            .format = "twin building",
            .num_frames = walk_->num_frames(),
            .has_depth = walk_->spec().sensors == Sensors::kRgbd,
            .is_calibrated = true,
            .frame_rate_hz = kFrameRate_hz};
  }

  std::optional<core::Frame> next() override {
    if (!workers_) start();
    std::optional<Made> made = workers_->next();
    if (!made) return std::nullopt;
    if (made->refusal && !is_refusal_told_) {
      spdlog::warn("{}", *made->refusal);
      is_refusal_told_ = true;
    }
    return std::move(made->frame);
  }

  core::Truth truth() const override { return core_truth(walk_->walk().poses, walk_->truth()); }

 private:
  struct Made {
    core::Frame frame;
    std::optional<std::string> refusal;  // of the cache to keep the pictures
  };

  void start() {
    studio_.emplace(*walk_, config_);
    const int num_workers =
        config_.num_workers > 0 ? config_.num_workers : core::num_hardware_threads();
    workers_.emplace(walk_->num_frames(), num_workers, [this](int index) { return make(index); });
  }

  Made make(int index) const {
    Made made{.frame = walk_->frame_without_pictures(index), .refusal = cache_.refusal()};
    std::optional<Pictures> pictures = cache_.load(index);
    if (!pictures) {
      pictures = studio_->pictures(index);
      if (!made.refusal) made.refusal = cache_.store(index, *pictures);
    }
    made.frame.images = std::move(pictures->images);
    made.frame.depth_m = std::move(pictures->depth_m);
    return made;
  }

  std::shared_ptr<const Walkthrough> walk_;
  Config config_;
  PictureCache cache_;
  std::optional<Studio> studio_;
  bool is_refusal_told_ = false;
  std::optional<FrameWorkers<Made>> workers_;  // last: they end before what they use
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
