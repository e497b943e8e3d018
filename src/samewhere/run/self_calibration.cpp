#include <cmath>
#include <filesystem>
#include <utility>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/core/interrupt.hpp>
#include <samewhere/input/exif.hpp>
#include <samewhere/input/guess_camera.hpp>
#include <samewhere/map/full_bundle.hpp>
#include <samewhere/optimize/focal_length.hpp>
#include <samewhere/pipeline/slam.hpp>
#include <samewhere/report/figure.hpp>
#include <samewhere/run/open_source.hpp>
#include <samewhere/run/self_calibration.hpp>

namespace samewhere::run {
namespace {

constexpr double kGuess_sigma = 0.2;  // of a guessed focal length, as a share of it

// Of the first picture of a folder, if it is a JPEG that says it.
std::optional<double> film_length_mm(const pipeline::Config& config, const core::Frame& frame) {
  const std::filesystem::path picture = std::filesystem::path(config.source) / frame.name;
  std::error_code error;
  if (!std::filesystem::is_regular_file(picture, error)) return std::nullopt;
  return input::focal_length_35mm(core::read_file(picture));
}

// The map of the beginning of a recording, of as many keyframes as are asked for, or of all of it.
scene::MapVersion first_map(core::Source& source, const pipeline::Config& given) {
  constexpr int kMostFrames = 3000;
  pipeline::Config config = with_window_in_frames(given, source.info());
  config.odometry.file.clear();
  pipeline::Slam slam(config, is_scale_free(source.info()) ? pipeline::DepthFrom::kMotion
                                                           : pipeline::DepthFrom::kSensor);
  for (int i = 0; i < kMostFrames && !core::is_interrupted(); ++i) {
    const std::optional<core::Frame> frame = source.next();
    if (!frame) break;
    slam.feed(*frame);
    const core::FramePose& pose = slam.frames().back();
    const auto wanted = static_cast<std::uint64_t>(config.input.focal_length_keyframes);
    if (pose.is_measured && pose.reference_keyframe.index() + 1 >= wanted) break;
  }
  slam.finish();
  return slam.map();
}

std::optional<optimize::FocalLengthFit> fit(const scene::MapVersion& map,
                                            const pipeline::Config& config) {
  constexpr std::size_t kMinKeyframes = 8;
  const map::BundleWindow window = map::window_of_all(map, config.map);
  if (window.free.size() < kMinKeyframes) return std::nullopt;
  optimize::BundleProblem problem = map::bundle_problem(map, window, config.features);
  // how two keyframes lie to each other was found with the wrong focal length, too
  for (std::size_t i = 0; i + 1 < problem.cameras.size(); ++i) problem.cameras[i].is_fixed = false;
  return optimize::fit_focal_length(problem, kGuess_sigma);
}

// A map made with a wrong focal length is distorted: it is made once more with the better one.
void refine(const pipeline::Config& config, SelfCalibration& calibration) {
  constexpr int kMostPasses = 3;
  constexpr double kSettled = 0.02;
  constexpr double kFarthest = 2.0;
  for (int pass = 0; pass < kMostPasses && !core::is_interrupted(); ++pass) {
    const auto source =
        for_slam(input::with_camera(open_source(config), calibration.camera), config);
    const auto found = fit(first_map(*source, config), config);
    if (!found) return;
    const double f_px = calibration.camera.fx_px * found->ratio;
    const double off = f_px / calibration.guessed_px;
    if (!(off < kFarthest && off > 1.0 / kFarthest)) return;
    calibration.camera.fx_px = calibration.camera.fy_px = f_px;
    calibration.sigma_px = calibration.camera.fx_px * found->ratio_sigma / found->ratio;
    if (std::abs(std::log(found->ratio)) < kSettled) return;
  }
}

}  // namespace

std::optional<SelfCalibration> calibrate_if_unknown(std::unique_ptr<core::Source>& source,
                                                    const pipeline::Config& config) {
  const core::SourceInfo info = source->info();
  if (info.is_calibrated || info.num_cameras != 1) return std::nullopt;
  input::Peeked peeked = input::peek(std::move(source));
  source = std::move(peeked.source);
  if (!peeked.first) return std::nullopt;
  const input::GuessedCamera guess =
      input::guess_camera(peeked.first->images.front().size(), config.input.fov_deg,
                          film_length_mm(config, *peeked.first));
  SelfCalibration calibration{guess.camera, guess.camera.fx_px, std::nullopt};
  spdlog::warn(
      "{}: no calibration; focal length {:.1f} px from {}, no distortion. --camera FILE gives the "
      "calibrated one, `samewhere calibrate` writes it",
      config.source, calibration.guessed_px, guess.reason);
  const bool may_refine =
      !info.is_live && config.input.fov_deg == 0.0 && config.input.focal_length_keyframes > 0;
  if (may_refine) {
    refine(config, calibration);
    source = open_source(config);
    if (calibration.sigma_px) {
      spdlog::warn("{}: focal length estimated by bundle adjustment: {}", config.source,
                   focal_length_figure(calibration).value);
    } else {
      spdlog::warn(
          "{}: the focal length is not observable in the first part of the recording; the guess "
          "stays",
          config.source);
    }
  }
  source = input::with_camera(std::move(source), calibration.camera);
  return calibration;
}

report::Figure focal_length_figure(const SelfCalibration& calibration) {
  const double f_px = calibration.camera.fx_px;
  if (!calibration.sigma_px) return report::figure("focal length", "{:.1f} px, guessed", f_px);
  return report::figure("focal length", "{:.1f} px +- {:.1f} (guessed {:.1f} px)", f_px,
                        *calibration.sigma_px, calibration.guessed_px);
}

}  // namespace samewhere::run
