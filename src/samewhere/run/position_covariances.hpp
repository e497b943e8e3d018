#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <samewhere/pipeline/config.hpp>
#include <samewhere/report/record.hpp>
#include <samewhere/scene/map_version.hpp>

namespace samewhere::run {

// How uncertain the positions of the session's keyframes are relative to its first one, by odometry
// and the accepted loop closures (verify/drift_path.hpp), at most max_num of them, evenly spread.
// Keyframes that neither joins to the first are left out. Not for maps with scale drift.
std::vector<report::PositionCovariance> position_covariances(const scene::MapVersion& map,
                                                             std::uint16_t session,
                                                             const pipeline::Config& config,
                                                             std::size_t max_num);

}  // namespace samewhere::run
