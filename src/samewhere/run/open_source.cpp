#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/input/enlarge.hpp>
#include <samewhere/input/open.hpp>
#include <samewhere/input/rectify.hpp>
#include <samewhere/run/open_source.hpp>
#include <samewhere/twin/front/twin.hpp>

namespace samewhere::run {

std::unique_ptr<core::Source> open_source(const pipeline::Config& config) {
  return input::rectified(twin::is_twin_spec(config.source)
                              ? twin::open_twin(config.source, config.twin)
                              : input::open_source(config.source, config.input));
}

std::unique_ptr<core::Source> open_source_with_truth(const pipeline::Config& config) {
  if (!twin::is_twin_spec(config.source)) return open_source(config);
  const auto walk =
      std::make_shared<const twin::Walkthrough>(twin::parse_spec(config.source), config.twin);
  twin::watched_truth(*walk);
  return input::rectified(twin::open_twin(walk, config.twin));
}

std::unique_ptr<core::Source> for_slam(std::unique_ptr<core::Source> source,
                                       const pipeline::Config& config) {
  return config.input.enlarge ? input::enlarged(std::move(source)) : std::move(source);
}

bool is_scale_free(const core::SourceInfo& info) {
  return !info.has_depth && info.num_cameras == 1;
}

void require_slam_input(const core::SourceInfo& info, const pipeline::Config& config) {
  if (!info.is_calibrated) {
    throw core::InputError(fmt::format(
        "{}: no camera file; `samewhere run` needs one for stereo; expected the "
        "calibration of the recording's format or --camera FILE (`samewhere loops` works without)",
        config.source));
  }
}

pipeline::Config with_window_in_frames(pipeline::Config config, const core::SourceInfo& info) {
  constexpr double kLongest_frames = 1e9;
  auto& retrieve = config.retrieve;
  if (retrieve.window_frames < 0) {
    retrieve.window_frames = static_cast<int>(
        std::lround(std::min(retrieve.window_s * info.frame_rate_hz, kLongest_frames)));
  }
  return config;
}

std::string absolute_source(const std::string& source) {
  if (twin::is_twin_spec(source)) return source;
  return std::filesystem::absolute(source).lexically_normal().string();
}

}  // namespace samewhere::run
