#pragma once

#include <optional>

#include <samewhere/core/source.hpp>
#include <samewhere/core/truth.hpp>
#include <samewhere/pipeline/config.hpp>

namespace samewhere::paper {

// The source's truth with places: as it came, or from depth and true poses
// (evaluate/depth_places.hpp), for which all depth is read. Throws InputError naming the source if
// nothing tells of places; Interrupted after Ctrl-C.
core::Truth truth_with_places(const core::Source& source, const pipeline::Config& config);

// Places from depth and true poses. Nothing without depth or calibration.
std::optional<core::PlaceTruthMatrix> places_by_depth(core::Source& source,
                                                      const core::Trajectory& truth);

// Throws InputError as truth_with_places() does, without that work. Rendered buildings are not
// asked: they have to compute their places.
void require_place_truth(const core::Source& source, const pipeline::Config& config);

}  // namespace samewhere::paper
