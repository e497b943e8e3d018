#pragma once

#include <memory>
#include <optional>
#include <string>

#include <samewhere/core/source.hpp>
#include <samewhere/pipeline/config.hpp>
#include <samewhere/report/record.hpp>

namespace samewhere::run {

// The camera of a recording that came without calibration.
struct SelfCalibration {
  core::PinholeRadtan camera;
  double guessed_px = 0.0;         // focal length at first
  std::optional<double> sigma_px;  // of the estimated focal length; nothing: it is the guess
};

// If the source is of one camera and has no calibration: a guess (input/guess_camera.hpp), and the
// source with it. The focal length is then estimated in a first pass of SLAM over the recording, by
// bundle adjustment over its map (optimize/focal_length.hpp), as soon as that has
// input.focal_length_keyframes keyframes; the centre stays in the middle and distortion is not
// estimated. A camera's frames come once: there, or with input.fov_deg, the guess stays. Warns in
// the log with the focal length. Nothing, and the source as it was, if it has a calibration, or two
// cameras.
std::optional<SelfCalibration> calibrate_if_unknown(std::unique_ptr<core::Source>& source,
                                                    const pipeline::Config& config);

// "612.4 px +- 3.1 (guessed 560.0 px)".
report::Figure focal_length_figure(const SelfCalibration& calibration);

}  // namespace samewhere::run
