#include <cstdint>
#include <utility>

#include <fmt/format.h>

#include <samewhere/map/mapper.hpp>
#include <samewhere/pipeline/initialization.hpp>

namespace samewhere::pipeline {

Initialization::Initialization(const Config& config, DepthFrom depth_from) : config_(config.map) {
  if (depth_from == DepthFrom::kMotion) {
    starter_.emplace(track::StartSettings{config.track.initialization, config.track.drift,
                                          config.features, config.optimize,
                                          static_cast<std::uint64_t>(config.seed)});
  }
}

std::optional<InitialViews> Initialization::try_view(const features::View& view,
                                                     const cv::Mat& image) {
  num_features_ = view.features->size();
  if (starter_) return try_pair(view, image);
  num_with_depth_ = map::num_with_depth(view);
  if (!map::can_start(view, config_)) return std::nullopt;
  return InitialViews{StartMap{view, image}, num_with_depth_, {}};
}

std::optional<InitialViews> Initialization::try_pair(const features::View& view,
                                                     const cv::Mat& image) {
  auto pair = starter_->offer(view);
  if (!pair) return std::nullopt;
  const track::Start& start = pair->start;
  return InitialViews{StartMapByMotion{{pair->first, view, start.first_from_second,
                                        start.information, start.matches, start.points_in_first},
                                       image},
                      static_cast<int>(start.matches.size()), std::move(pair->between)};
}

void Initialization::reset() {
  if (starter_) starter_->forget();
}

core::FrameStatus Initialization::waiting_status(const features::View& view) const {
  using enum core::FrameStatus;
  if (view.features->size() < config_.min_landmarks) return kWaitingForFeatures;
  return starter_ ? kWaitingForParallax : kWaitingForDepth;
}

std::string Initialization::why_not() const {
  if (num_features_ < config_.min_landmarks) {
    return fmt::format("{} corners in the picture, expected {}: it is dark, blurred or of one tone",
                       num_features_, config_.min_landmarks);
  }
  if (!starter_ && num_with_depth_ == 0) {
    return fmt::format(
        "none of {} features has depth, expected {}: the depth pictures are missing or empty",
        num_features_, config_.min_landmarks);
  }
  if (!starter_) {
    return fmt::format("{} features with depth, expected {}", num_with_depth_,
                       config_.min_landmarks);
  }
  return starter_->last_refusal().empty() ? "there is no second view" : starter_->last_refusal();
}

}  // namespace samewhere::pipeline
