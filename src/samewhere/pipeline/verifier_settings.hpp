#pragma once

#include <samewhere/pipeline/config.hpp>
#include <samewhere/verify/loop_verifier.hpp>

namespace samewhere::pipeline {

// Loop closing: each keyframe is verified by itself, without sequences.
verify::VerifierSettings loop_settings(const Config& config);

// Relocalization: no sequences, and no relative pose is required, since the hypotheses are tracked
// (docs/decisions/017). The features are matched by features_of_lost().
verify::VerifierSettings relocalization_settings(const Config& config);

// Recognition alone: as configured.
verify::VerifierSettings recognition_settings(const Config& config);

}  // namespace samewhere::pipeline
