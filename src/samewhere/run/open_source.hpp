#pragma once

#include <memory>
#include <string>

#include <samewhere/core/source.hpp>
#include <samewhere/pipeline/config.hpp>

namespace samewhere::run {

// A recording or a twin building, by what config.source says; a calibrated pair of cameras comes
// rectified. Throws InputError.
std::unique_ptr<core::Source> open_source(const pipeline::Config& config);

// The same with ground truth: what a rendered building has to compute for it is computed now, with
// a progress line on stderr. Throws InputError, and Interrupted after Ctrl-C.
std::unique_ptr<core::Source> open_source_with_truth(const pipeline::Config& config);

// What SLAM is given of a source: small pictures are enlarged (input/enlarge.hpp), unless
// config.input.enlarge says otherwise.
std::unique_ptr<core::Source> for_slam(std::unique_ptr<core::Source> source,
                                       const pipeline::Config& config);

// Whether the size of the world cannot be measured: one camera, no depth.
bool is_scale_free(const core::SourceInfo& info);

// Throws InputError if the source lacks the calibration that SLAM needs (self_calibration.hpp
// guesses that of one camera).
void require_slam_input(const core::SourceInfo& info, const pipeline::Config& config);

// The config with retrieve.window_frames: given in it, or window_s at the source's frame rate.
pipeline::Config with_window_in_frames(pipeline::Config config, const core::SourceInfo& info);

// `source` such that it means the same from any folder: an absolute path; a twin's name stays as it
// is.
std::string absolute_source(const std::string& source);

}  // namespace samewhere::run
