#include <exception>
#include <optional>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <samewhere/core/checksum.hpp>
#include <samewhere/core/ordered_workers.hpp>
#include <samewhere/core/tum_file.hpp>
#include <samewhere/twin/front/studio.hpp>
#include <samewhere/twin/front/twin.hpp>
#include <samewhere/twin/render/picture_cache.hpp>
#include <samewhere/twin/render/source_hash.hpp>

namespace samewhere::twin {
namespace {

PictureCache cache_for(const Walkthrough& walk, const Config& config) {
  // whatever is built from other sources may render otherwise
  std::string key =
      fmt::format("{} pictures of build {}", canonical_text(walk.spec()), source_hash());
  if (!config.shake.empty())
    key += fmt::format(" moved as {:016x}", core::checksum(core::tum_text(walk.walk().poses)));
  // ideal depth is not in the units that the cache keeps
  return config.ideal_depth ? PictureCache(key, std::nullopt) : PictureCache(key);
}

// Frames come from the cache as long as it has them. The studio, whose light takes seconds, is
// opened with the first that is missing.
class TwinSource : public core::Source {
 public:
  TwinSource(std::shared_ptr<const Walkthrough> walk, const Config& config)
      : walk_(std::move(walk)), config_(config), cache_(cache_for(*walk_, config)) {
    if (cache_.notice()) spdlog::warn("{}", *cache_.notice());
  }

  core::SourceInfo info() const override {
    return {.name = walk_->name(),
            .format = "twin building",
            .num_frames = walk_->num_frames(),
            .has_depth = walk_->spec().sensors == Sensors::kRgbd,
            .num_cameras = walk_->spec().sensors == Sensors::kStereo ? 2 : 1,
            .is_calibrated = true,
            .frame_rate_hz = kFrameRate_hz};
  }

  std::optional<core::Frame> next() override {
    if (failure_) std::rethrow_exception(failure_);
    try {
      return next_frame();
    } catch (...) {
      failure_ = std::current_exception();
      throw;
    }
  }

  core::Truth truth() const override {
    core::Truth truth = core_truth(walk_->walk().poses, walk_->truth());
    truth.inertial = walk_->inertial_truth();
    return truth;
  }
  core::Trajectory true_trajectory() const override { return walk_->walk().poses; }

 private:
  struct Made {
    core::Frame frame;                   // without images: missing, and there is no studio yet
    std::optional<std::string> refusal;  // of the cache to keep the pictures
  };

  std::optional<core::Frame> next_frame() {
    if (!workers_) {
      if (!cache_.load(0)) studio_.emplace(*walk_, config_);
      start(0);
    }
    std::optional<Made> made = workers_->next();
    if (made && made->frame.images.empty()) {
      const int missing = static_cast<int>(made->frame.id.value());
      workers_.reset();
      studio_.emplace(*walk_, config_);
      start(missing);
      made = workers_->next();
    }
    if (!made) return std::nullopt;
    if (made->refusal && !is_refusal_told_) {
      spdlog::warn("{}", *made->refusal);
      is_refusal_told_ = true;
    }
    return std::move(made->frame);
  }

  void start(int first) {
    workers_.emplace(walk_->num_frames() - first, num_threads(config_),
                     [this, first](int index) { return make(first + index); });
  }

  Made make(int index) const {
    Made made{.frame = walk_->frame_without_pictures(index), .refusal = cache_.refusal()};
    std::optional<Pictures> pictures = cache_.load(index);
    if (!pictures && !studio_) return made;
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
  std::optional<Studio> studio_;  // while no worker runs it may be opened
  bool is_refusal_told_ = false;
  std::exception_ptr failure_;                         // no frames come after it
  std::optional<core::OrderedWorkers<Made>> workers_;  // last: they end before what they use
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
