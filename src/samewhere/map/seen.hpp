#pragma once

#include <optional>
#include <vector>

#include <samewhere/features/config.hpp>
#include <samewhere/features/match_projected.hpp>
#include <samewhere/optimize/reprojection.hpp>
#include <samewhere/scene/map_version.hpp>

namespace samewhere::map {

// The measurement of feature `slot` of the view for the solvers: sigma grows with the octave.
optimize::SeenAt seen_at(const features::View& view, int slot, const features::Config& config);

core::Rigid3 camera_from_world(const scene::MapVersion& map, const scene::Keyframe& keyframe);

// Reprojection error of the point at the feature, in standard deviations.
optimize::Reprojection reproject(const features::View& view, int slot,
                                 const Eigen::Vector3d& point_in_camera,
                                 const features::Config& config);

// Where a keyframe should see a landmark: inside the picture, from the side on which it was seen
// (within 60 degrees), at a range at which it has a level of the pyramid. Nothing if it should not.
// `row` is left to the caller.
std::optional<features::ProjectedPoint> expected_at(const scene::MapVersion& map,
                                                    const scene::Keyframe& keyframe,
                                                    const scene::Landmark& landmark,
                                                    const features::Config& config);

// Whether the keyframe observes the landmark.
bool is_seen_by(const scene::Landmark& landmark, core::KeyframeId keyframe);

}  // namespace samewhere::map
